// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.h"

#include "errors.h"
#include "text.h"

#include <algorithm>
#include <cmath>

namespace glimmer {
namespace {

struct NamedArray {
    NpyArray array;
    std::string name; ///< for messages
};

NamedArray read_npy(const Value &value, const std::vector<std::vector<size_t>> &shapes, const std::string &allowed,
                    SceneFolder &folder) {
    const auto file = folder.read(value);
    NamedArray result{{}, value.where() + ": " + in_quotes(file.name)};
    result.array = parse_npy(file.bytes, result.name);
    const auto &shape = result.array.shape;
    const bool fits = std::any_of(shapes.begin(), shapes.end(), [&](const std::vector<size_t> &wanted) {
        return wanted.size() == shape.size() &&
               std::equal(wanted.begin(), wanted.end(), shape.begin(),
                          [](size_t want, size_t is) { return want == 0 || want == is; });
    });
    if (!fits)
        throw InputError(result.name + ": shape " + result.array.shape_text() + " is not " + allowed);
    return result;
}

std::string bracketed(size_t i) {
    std::string text = "[";
    text += std::to_string(i); // "[" + ... sets off a false -Wrestrict in gcc 12
    return text += "]";
}

/// "[3][1]" of element i of an array of this width.
std::string element_place(size_t i, size_t width) {
    return width == 0 ? bracketed(i) : bracketed(i / width) + bracketed(i % width);
}

std::string shape_name(size_t width) {
    return width == 0 ? "(n,)" : "(n, " + std::to_string(width) + ")";
}

/// Flattens a list of lists; convert(number as Json, place) gives each element.
template <class T, class F>
std::vector<T> flatten(const Value &value, size_t width, F &&convert) {
    if (!value.json().is_array())
        value.refuse("a list or the name of an .npy file");
    std::vector<T> result;
    result.reserve(value.json().size() * std::max<size_t>(width, 1));
    for (size_t row = 0; row < value.json().size(); ++row) {
        const Json &element = value.json()[row];
        if (width == 0) {
            result.push_back(convert(element, result.size()));
            continue;
        }
        if (!element.is_array() || element.size() != width)
            Value(element, value.file(), child_path(value.path(), row)).expect_size(width);
        for (const Json &number : element)
            result.push_back(convert(number, result.size()));
    }
    return result;
}

} // namespace

NpyArray read_float_npy(const Value &value, const std::vector<std::vector<size_t>> &shapes, const std::string &allowed,
                        SceneFolder &folder) {
    auto [array, name] = read_npy(value, shapes, allowed, folder);
    if (!array.is_float())
        throw InputError(name + ": dtype " + in_quotes(array.dtype) + " is not float32 or float64");
    for (size_t i = 0; i < array.values.size(); ++i) {
        if (std::isfinite(array.values[i]))
            continue;
        std::string place;
        for (size_t d = array.shape.size(), rest = i; d-- > 0; rest /= array.shape[d])
            place.insert(0, bracketed(rest % array.shape[d]));
        throw InputError(name + ": element " + place + " is " + number_text(array.values[i]) +
                         "; finite numbers are allowed");
    }
    return std::move(array);
}

std::vector<double> read_float_array(const Value &value, size_t width, SceneFolder &folder) {
    if (value.json().is_string())
        return read_float_npy(value, {width == 0 ? std::vector<size_t>{0} : std::vector<size_t>{0, width}},
                              shape_name(width), folder)
            .values;
    return flatten<double>(value, width, [&](const Json &number, size_t i) {
        if (!number.is_number())
            Value(number, value.file(), value.path() + element_place(i, width)).number();
        return number.get<double>();
    });
}

std::vector<uint32_t> read_index_array(const Value &value, size_t width, uint32_t limit, SceneFolder &folder) {
    if (value.json().is_string()) {
        const auto [array, name] = read_npy(
            value, {width == 0 ? std::vector<size_t>{0} : std::vector<size_t>{0, width}}, shape_name(width), folder);
        if (array.is_float())
            throw InputError(name + ": dtype " + in_quotes(array.dtype) + " is not an integer type");
        std::vector<uint32_t> result;
        result.reserve(array.integers.size());
        for (const int64_t number : array.integers) {
            if (number < 0 || number > int64_t(limit))
                throw InputError(name + ": element " + element_place(result.size(), width) + " is " +
                                 std::to_string(number) + ", not an integer from 0 to " + std::to_string(limit));
            result.push_back(static_cast<uint32_t>(number));
        }
        return result;
    }
    return flatten<uint32_t>(value, width, [&](const Json &number, size_t i) {
        if (number.is_number_unsigned() && number.get<uint64_t>() <= limit)
            return number.get<uint32_t>();
        const Value element(number, value.file(), value.path() + element_place(i, width));
        return static_cast<uint32_t>(element.integer(0, int64_t(limit)));
    });
}

Attributes read_attributes(const Value &table, std::span<const std::pair<std::string_view, size_t>> rows_of,
                           glimmer_attribute_domain first, SceneFolder &folder) {
    std::vector<std::string_view> words;
    for (const auto &[word, rows] : rows_of)
        words.push_back(word);
    Attributes result;
    table.for_each_named([&](const std::string &name, const Value &value) {
        size_t domain = 0;
        if (rows_of.size() > 1) {
            value.expect_object({"domain", "values"});
            domain = one_of(value.at("domain"), "a domain", "domains", words);
        }
        const Value values = rows_of.size() > 1 ? value.at("values") : value;
        const NpyArray array =
            read_float_npy(values, {{0, 1}, {0, 2}, {0, 3}, {0, 4}}, "(n, 1), (n, 2), (n, 3) or (n, 4)", folder);
        if (array.shape[0] != rows_of[domain].second)
            values.fail("has " + std::to_string(array.shape[0]) + " rows; " + std::to_string(rows_of[domain].second) +
                        " are allowed, one for each " + std::string(rows_of[domain].first));
        result.names.push_back(name);
        result.values.emplace_back(array.values.begin(), array.values.end());
        result.list.push_back({result.names.back().c_str(), glimmer_attribute_domain(int(first) + int(domain)),
                               uint32_t(array.shape[1]), result.values.back().data()});
    });
    return result;
}

} // namespace glimmer
