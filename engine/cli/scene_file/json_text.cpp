// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_text.h"

#include "errors.h"
#include "json_syntax.h"
#include "text.h"

#include <algorithm>
#include <unordered_set>
#include <vector>

namespace glimmer {

std::string child_path(const std::string &path, std::string_view key) {
    const bool printable = std::none_of(key.begin(), key.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    const std::string name = printable ? std::string(key) : in_quotes(key); // a message is one line
    return path.empty() ? name : path + "." + name;
}
std::string child_path(const std::string &path, size_t index) {
    return path + "[" + std::to_string(index) + "]";
}

namespace {

/// Builds the tree and refuses what the usual builder lets pass in silence: the last of two equal keys would win.
class TreeBuilder : public nlohmann::json_sax<Json> {
  public:
    TreeBuilder(Json &root, std::string_view text, std::string file)
        : root_(root), text_(text), file_(std::move(file)) {}

    bool null() override { return put(nullptr); }
    bool boolean(bool value) override { return put(value); }
    bool number_integer(number_integer_t value) override { return put(value); }
    bool number_unsigned(number_unsigned_t value) override { return put(value); }
    bool number_float(number_float_t value, const string_t &) override { return put(value); }
    bool string(string_t &value) override { return put(std::move(value)); }
    bool binary(binary_t &) override { fail("binary values are not JSON"); }

    bool start_object(size_t) override { return open(Json::object()); }
    bool start_array(size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t &value) override {
        Level &level = levels_.back();
        if (!level.keys.insert(value).second)
            fail("key " + in_quotes(value) + " stands twice");
        level.next_key = std::move(value);
        return true;
    }

    bool parse_error(size_t position, const std::string &, const nlohmann::detail::exception &error) override {
        if (dynamic_cast<const nlohmann::detail::out_of_range *>(&error) != nullptr)
            fail("the number before character " + std::to_string(position) + " is too large; up to 1.8e308 is allowed");
        const std::string where = path(true);
        throw InputError(file_ + ": " + (where.empty() ? "" : where + ": ") + syntax(error.what(), position));
    }

  private:
    struct Level {
        Json *container;
        std::string next_key;
        std::unordered_set<std::string> keys;
    };

    /// Where the next value goes: in a list that is open, behind its elements; in those around it, at their last one.
    /// with_key: and the last key of the object that is open, for a fault in its value or behind it.
    std::string path(bool with_key = false) const {
        std::string result;
        for (const Level &level : levels_) {
            const bool is_innermost = &level == &levels_.back();
            if (level.container->is_array())
                result = child_path(result, level.container->size() - (is_innermost ? 0 : 1));
            else if (!is_innermost || (with_key && !level.next_key.empty()))
                result = child_path(result, level.next_key);
        }
        return result;
    }

    [[noreturn]] void fail(const std::string &what) const {
        const std::string where = path();
        throw InputError(file_ + ": " + (where.empty() ? "" : where + ": ") + what);
    }

    template <class T>
    Json *add(T &&value) {
        if (levels_.empty())
            return &(root_ = Json(std::forward<T>(value)));
        Level &level = levels_.back();
        if (level.container->is_array()) {
            level.container->push_back(Json(std::forward<T>(value)));
            return &level.container->back();
        }
        // Straight to the end: operator[] of an ordered object would search all keys before.
        auto &members = level.container->get_ref<Json::object_t &>();
        members.Json::object_t::Container::emplace_back(level.next_key, Json(std::forward<T>(value)));
        return &members.back().second;
    }
    template <class T>
    bool put(T &&value) {
        add(std::forward<T>(value));
        return true;
    }
    bool open(Json &&container) {
        if (levels_.size() == 64)
            fail("nested too deeply; 64 levels are allowed");
        levels_.push_back({add(std::move(container)), {}, {}});
        return true;
    }
    bool close() {
        levels_.pop_back();
        return true;
    }

    std::string place(size_t position) const {
        size_t line = 1, column = 1;
        for (size_t i = 0; i + 1 < position && i < text_.size(); ++i, ++column)
            if (text_[i] == '\n')
                ++line, column = 0;
        return "line " + std::to_string(line) + ", column " + std::to_string(column);
    }
    std::string syntax(const std::string &what, size_t position) const {
        return place(position) + ": " + describe_syntax_error(what, text_.substr(0, position));
    }

    Json &root_;
    std::string_view text_;
    std::string file_;
    std::vector<Level> levels_;
};

} // namespace

Json parse_json(std::string_view text, const std::string &file) {
    Json root;
    TreeBuilder builder(root, text, file);
    Json::sax_parse(text, &builder);
    return root;
}

} // namespace glimmer
