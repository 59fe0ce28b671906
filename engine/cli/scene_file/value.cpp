// SPDX-License-Identifier: GPL-3.0-or-later
#include "value.h"

#include "errors.h"
#include "text.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

std::string Range::text() const {
    const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
    const std::string above = has_low ? (open_low ? " above " : " from ") + number_text(low) : "";
    const std::string below = has_high ? (open_high ? " below " : " to ") + number_text(high) : "";
    if (has_low && !has_high && !open_low)
        return "a number of " + number_text(low) + " or more";
    return "a number" + above + (has_low && has_high && (open_low || open_high) ? " and" : "") + below;
}

std::string Value::where() const {
    return path_.empty() ? file_ : file_ + ": " + path_;
}
void Value::fail(const std::string &what) const {
    throw InputError(where() + ": " + what);
}
void Value::refuse(const std::string &allowed) const {
    fail(described() + " is not " + allowed);
}

std::string Value::described() const {
    switch (json_->type()) {
    case Json::value_t::null:
        return "null";
    case Json::value_t::object:
        return "an object";
    case Json::value_t::array:
        return "a list of " + std::to_string(json_->size());
    case Json::value_t::string:
        return in_quotes(json_->get_ref<const std::string &>());
    case Json::value_t::boolean:
        return json_->get<bool>() ? "true" : "false";
    case Json::value_t::number_float:
        return number_text(json_->get<double>());
    default:
        return json_->dump();
    }
}

std::optional<Value> Value::find(std::string_view key) const {
    for (const auto &member : json_->get_ref<const Json::object_t &>())
        if (member.first == key)
            return Value(member.second, file_, child_path(path_, key));
    return std::nullopt;
}

Value Value::at(std::string_view key) const {
    if (auto value = find(key))
        return *value;
    fail("the key " + in_quotes(key) + " is missing");
}

void Value::expect_table() const {
    if (!json_->is_object())
        refuse("an object {...}");
}

void Value::expect_object(std::span<const std::string_view> allowed) const {
    expect_table();
    for (const auto &[key, value] : json_->items()) {
        if (std::find(allowed.begin(), allowed.end(), key) != allowed.end())
            continue;
        std::string names;
        for (const std::string_view name : allowed)
            names += (names.empty() ? "" : ", ") + std::string(name);
        fail("unknown key " + in_quotes(key) + "; allowed here are " + names);
    }
}

void Value::expect_array() const {
    if (!json_->is_array())
        refuse("a list [...]");
}

void Value::expect_size(size_t n) const {
    if (!json_->is_array() || json_->size() != n)
        refuse("a list of " + std::to_string(n));
}

double Value::number(const Range &range) const {
    if (!json_->is_number() || !range.holds(json_->get<double>()))
        refuse(range.text());
    return json_->get<double>();
}

float Value::single(const Range &range) const {
    const double exact = number(range);
    if (std::abs(exact) > double(std::numeric_limits<float>::max()))
        fail(described() + " is too large; up to 3.4e38 is allowed");
    const float value = static_cast<float>(exact);
    if (!range.holds(double(value)))
        fail(described() + " as a 32-bit float is not " + range.text());
    return value;
}

int64_t Value::integer(int64_t low, int64_t high) const {
    const std::string allowed = low == high ? std::to_string(low) + ", the only value that is allowed here"
                                            : "an integer from " + std::to_string(low) + " to " + std::to_string(high);
    int64_t value = 0;
    if (json_->is_number_unsigned()) {
        const uint64_t number = json_->get<uint64_t>();
        if (number > uint64_t(std::numeric_limits<int64_t>::max()))
            refuse(allowed);
        value = static_cast<int64_t>(number);
    } else if (json_->is_number_integer()) {
        value = json_->get<int64_t>();
    } else {
        refuse(allowed);
    }
    if (value < low || value > high)
        refuse(allowed);
    return value;
}

bool Value::boolean() const {
    if (!json_->is_boolean())
        refuse("true or false");
    return json_->get<bool>();
}

std::string Value::text() const {
    if (!json_->is_string())
        refuse("a text in double quotes");
    return json_->get<std::string>();
}

Double3 Value::direction() const {
    const Double3 value = numbers<3>();
    if (value == Double3{0, 0, 0})
        fail("[0, 0, 0] is not a direction; one component at least is not 0");
    return value;
}

Float3 Value::color(const Range &range) const {
    if (json_->is_number()) {
        const float grey = single(range);
        return {grey, grey, grey};
    }
    if (!json_->is_array() || json_->size() != 3)
        refuse("a number or a list of 3");
    Float3 result;
    for (size_t i = 0; i < 3; ++i)
        result[i] = Value((*json_)[i], file_, child_path(path_, i)).single(range);
    return result;
}

Double3 Value::color_double(const Range &range) const {
    if (json_->is_number()) {
        const double grey = number(range);
        return {grey, grey, grey};
    }
    if (!json_->is_array() || json_->size() != 3)
        refuse("a number or a list of 3");
    return numbers<3>(range);
}

Matrix Value::matrix() const {
    if (!json_->is_array() || json_->size() != 4)
        refuse("a 4x4 matrix (4 rows of 4 numbers)");
    Matrix result;
    for (size_t row = 0; row < 4; ++row) {
        const auto values = Value((*json_)[row], file_, child_path(path_, row)).numbers<4>();
        std::copy(values.begin(), values.end(), result.begin() + static_cast<ptrdiff_t>(4 * row));
    }
    if (result[12] != 0 || result[13] != 0 || result[14] != 0 || result[15] != 1)
        fail("the last row is " + number_text(result[12]) + " " + number_text(result[13]) + " " +
             number_text(result[14]) + " " + number_text(result[15]) +
             ", not 0 0 0 1 (column vectors: the translation is the last column)");
    return result;
}

size_t one_of(const Value &value, std::string_view noun, std::string_view plural,
              std::span<const std::string_view> names) {
    const std::string text = value.text();
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        refuse_name(value, noun, plural, {names.begin(), names.end()});
    return static_cast<size_t>(found - names.begin());
}

void refuse_name(const Value &value, std::string_view noun, std::string_view plural,
                 const std::vector<std::string> &names) {
    value.refuse(std::string(noun) + "; " + std::string(plural) + " are " + quoted_list(names));
}

} // namespace glimmer
