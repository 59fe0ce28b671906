// SPDX-License-Identifier: GPL-3.0-or-later
// A value of the scene file together with its place in it, so that every complaint can name that place.
#pragma once

#include "json_text.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glimmer {

/// What a number may be. Open ends leave the limit itself out.
struct Range {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool open_low = false, open_high = false;

    bool holds(double value) const {
        return (open_low ? value > low : value >= low) && (open_high ? value < high : value <= high);
    }
    /// "a number from 0 to 1", "a number above 0", "a number of 0 or more", ...
    std::string text() const;
};
inline constexpr Range kAny{};
inline constexpr Range kUnit{0, 1};
inline constexpr Range kNonNegative{.low = 0};
inline constexpr Range kPositive{.low = 0, .open_low = true};

using Float3 = std::array<float, 3>;
using Double2 = std::array<double, 2>;
using Double3 = std::array<double, 3>;
using Matrix = std::array<double, 16>;

/// A node of the tree. Copies share the tree, which must outlive them. Every function throws InputError that starts
/// with "FILE: KEY.PATH: ".
class Value {
  public:
    Value(const Json &json, std::string file, std::string path = "")
        : json_(&json), file_(std::move(file)), path_(std::move(path)) {}

    const Json &json() const { return *json_; }
    const std::string &file() const { return file_; }
    const std::string &path() const { return path_; }
    /// "FILE: KEY.PATH" for messages that the engine writes.
    std::string where() const;
    [[noreturn]] void fail(const std::string &what) const;
    /// "1.5 is not ALLOWED", as in "a number from 0 to 1".
    [[noreturn]] void refuse(const std::string &allowed) const;

    /// The value of a key of this object, or the error that it is missing.
    Value at(std::string_view key) const;
    std::optional<Value> find(std::string_view key) const;
    bool has(std::string_view key) const { return find(key).has_value(); }
    /// An object with no other keys than these.
    void expect_object(std::span<const std::string_view> allowed) const;
    void expect_object(std::initializer_list<std::string_view> allowed) const {
        expect_object(std::span(allowed.begin(), allowed.size()));
    }
    /// An array; calls back with each of its elements.
    template <class F>
    void for_each(F &&function) const {
        expect_array();
        for (size_t i = 0; i < json_->size(); ++i)
            function(Value((*json_)[i], file_, child_path(path_, i)));
    }
    /// An object used as a table; calls back with each name and value, in the file's order.
    template <class F>
    void for_each_named(F &&function) const {
        expect_table();
        for (const auto &[name, value] : json_->items())
            function(name, Value(value, file_, child_path(path_, name)));
    }

    double number(const Range &range = kAny) const;
    /// A number that stays within the range once it is a float32.
    float single(const Range &range = kAny) const;
    int64_t integer(int64_t low, int64_t high) const;
    /// true or false.
    bool boolean() const;
    std::string text() const;
    template <size_t n>
    std::array<double, n> numbers(const Range &range = kAny) const {
        std::array<double, n> result;
        expect_size(n);
        for (size_t i = 0; i < n; ++i)
            result[i] = Value((*json_)[i], file_, child_path(path_, i)).number(range);
        return result;
    }
    /// [x, y, z] that is not [0, 0, 0].
    Double3 direction() const;
    /// A 3-list or one number for all three.
    Float3 color(const Range &range) const;
    Double3 color_double(const Range &range) const;
    /// 4x4, row-major, last row 0 0 0 1.
    Matrix matrix() const;

    void expect_array() const;
    void expect_table() const;
    void expect_size(size_t n) const;
    /// "a list", "the number 3", ...: the value for messages.
    std::string described() const;

  private:
    const Json *json_;
    std::string file_, path_;
};

/// The position of a text in a table of names, or the error `"hexx" is not a NOUN; PLURAL are "hex", "tri"`.
size_t one_of(const Value &value, std::string_view noun, std::string_view plural,
              std::span<const std::string_view> names);

/// That error.
[[noreturn]] void refuse_name(const Value &value, std::string_view noun, std::string_view plural,
                              const std::vector<std::string> &names);

} // namespace glimmer
