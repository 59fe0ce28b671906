// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"
#include "text.h"

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <span>

namespace glimmer {
namespace {

/// What may give a material's shading normal: one of them.
constexpr std::array kNormals{"normal", "bumped_normal", "bumped_normal_cubic"};

/// The parameters of each type, from the engine's table.
class Schema {
  public:
    Schema() {
        for (uint32_t i = 0; const auto *info = glimmer_material_info(i); ++i) {
            types_.emplace_back(info->type);
            mixable_.push_back(info->mixable != 0);
            rows_.emplace_back();
        }
        for (uint32_t i = 0; const auto *info = glimmer_parameter_info(i); ++i)
            rows_[size_t(std::find(types_.begin(), types_.end(), info->type) - types_.begin())].push_back(info);
    }

    std::span<const std::string_view> types() const { return types_; }
    std::span<const glimmer_parameter_info_t *const> parameters(size_t type) const { return rows_[type]; }
    bool mixable(size_t type) const { return mixable_[type]; }
    /// "light, glass or null"
    std::string unmixable() const {
        std::vector<std::string_view> names;
        for (size_t i = 0; i < types_.size(); ++i)
            if (!mixable_[i])
                names.push_back(types_[i]);
        std::string out;
        for (size_t i = 0; i < names.size(); ++i)
            out += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
        return out;
    }

  private:
    std::vector<std::string_view> types_;
    std::vector<bool> mixable_;
    std::vector<std::vector<const glimmer_parameter_info_t *>> rows_;
};

std::vector<std::string_view> words_of(const glimmer_parameter_info_t &info) {
    std::vector<std::string_view> words;
    std::string_view rest = info.words;
    for (size_t end; (end = rest.find(' ')) != std::string_view::npos; rest.remove_prefix(end + 1))
        words.push_back(rest.substr(0, end));
    words.push_back(rest);
    return words;
}

/// Throws what the engine says of a material that it refused, without the name, which the place in the file has.
void check_material(glimmer_result result, const Value &value, const std::string &name) {
    const std::string label = name.empty() ? "material: " : "material \"" + name + "\": ", what = glimmer_last_error();
    if (result == GLIMMER_INVALID_ARGUMENT && what.size() > label.size())
        value.fail(what.substr(label.size()));
    check(result, value.where());
}

/// Adds materials depth first, so that the engine gets the parts of a mix before the mix.
class MaterialReader {
  public:
    MaterialReader(const Value &table, const Programs &programs, glimmer_scene *scene)
        : table_(table), programs_(programs), scene_(scene) {}

    Materials read() {
        table_.for_each_named([&](const std::string &name, const Value &value) {
            result_.names.push_back(name);
            values_.emplace(name, value);
        });
        for (const std::string &name : result_.names)
            add_named(name);
        return std::move(result_);
    }

  private:
    struct Added {
        uint32_t index;
        size_t type;
    };

    Added add_named(const std::string &name) {
        if (const auto found = added_.find(name); found != added_.end())
            return found->second;
        const Value &value = values_.at(name);
        open_.push_back(name);
        const Added added = add(value, name);
        open_.pop_back();
        added_.emplace(name, added);
        result_.indices.emplace(name, added.index);
        return added;
    }

    /// a or b of a mix: a name, or a material in place.
    uint32_t add_part(const Value &part, const std::string &inline_name) {
        Added added;
        if (part.json().is_string()) {
            const std::string name = part.text();
            if (!values_.contains(name))
                refuse_name(part, "a material", "materials", result_.names);
            if (const auto start = std::find(open_.begin(), open_.end(), name); start != open_.end()) {
                std::string circle;
                for (auto link = start; link != open_.end(); ++link)
                    circle += in_quotes(*link) + " -> ";
                part.fail("a mix is a part of itself: " + circle + in_quotes(name));
            }
            added = add_named(name);
        } else {
            added = add(part, inline_name);
        }
        if (!schema_.mixable(added.type))
            part.fail("neither part of a mix may be " + schema_.unmixable());
        return added.index;
    }

    Added add(const Value &value, const std::string &name) {
        value.expect_table();
        const size_t type = one_of(value.at("type"), "a material type", "material types", schema_.types());
        std::vector<std::string_view> keys{"type"};
        for (const auto *info : schema_.parameters(type))
            keys.emplace_back(info->key);
        keys.insert(keys.end(), kNormals.begin(), kNormals.end());
        keys.emplace_back("aovs");
        value.expect_object(keys);
        std::vector<glimmer_parameter> parameters;
        std::vector<std::pair<const char *, Value>> varying; // the engine says what may vary
        for (const char *key : kNormals)
            if (const auto normal = value.find(key)) {
                if (!varying.empty())
                    value.fail("has more than one normal");
                varying.emplace_back(key, *normal);
            }
        if (const auto aovs = value.find("aovs")) {
            std::vector<std::string_view> names;
            for (const std::string &aov : aov_keys_)
                names.push_back(aov);
            aovs->expect_object(names);
            for (const std::string &aov : aov_keys_)
                if (const auto given = aovs->find(aov.c_str()))
                    varying.emplace_back(aov.c_str(), *given);
        }
        for (const auto *info : schema_.parameters(type))
            if (const auto given = value.find(info->key)) {
                if (is_binding(*given) && (info->kind == GLIMMER_NUMBER || info->kind == GLIMMER_COLOR)) {
                    varying.emplace_back(info->key, *given);
                    parameters.push_back(stand_in(*info));
                } else {
                    parameters.push_back(read(*given, *info, name));
                }
            }
        glimmer_material_desc desc;
        glimmer_material_init(&desc);
        desc.name = name.c_str();
        desc.type = schema_.types()[type].data();
        desc.parameter_count = parameters.size();
        desc.parameters = parameters.data();
        uint32_t index = 0;
        check_material(glimmer_scene_add_material(scene_, &desc, &index), value, name);
        for (const auto &[key, given] : varying) {
            const Binding binding = programs_.read_binding(given);
            check_material(glimmer_scene_bind(scene_, index, key, binding.program, binding.output), given, name);
        }
        return {index, type};
    }

    /// For what a program gives: something within the parameter's range.
    static glimmer_parameter stand_in(const glimmer_parameter_info_t &info) {
        glimmer_parameter parameter{};
        parameter.key = info.key;
        for (float &value : parameter.value)
            value = float(std::clamp(0.5, info.low, info.high));
        return parameter;
    }

    glimmer_parameter read(const Value &value, const glimmer_parameter_info_t &info, const std::string &name) {
        const Range range{info.low, info.high, info.above_low != 0};
        glimmer_parameter parameter{};
        parameter.key = info.key;
        switch (info.kind) {
        case GLIMMER_NUMBER:
            parameter.value[0] = value.single(range);
            break;
        case GLIMMER_COLOR: {
            const Float3 color = value.color(range);
            std::copy(color.begin(), color.end(), parameter.value);
            break;
        }
        case GLIMMER_WORD: {
            const std::vector<std::string_view> words = words_of(info);
            const std::string noun = info.noun;
            parameter.word = words_.emplace_back(words[one_of(value, "a " + noun, noun + "s", words)]).c_str();
            break;
        }
        case GLIMMER_MATERIAL:
            parameter.material = add_part(value, name + "." + info.key);
        }
        return parameter;
    }

    static std::vector<std::string> aov_keys() {
        std::vector<std::string> keys;
        for (uint32_t i = 0; i < GLIMMER_MAX_AOVS; ++i)
            keys.push_back("aov_" + std::to_string(i + 1));
        return keys;
    }

    Schema schema_;
    std::vector<std::string> aov_keys_ = aov_keys();
    std::deque<std::string> words_; ///< what parameters point to
    const Value &table_;
    const Programs &programs_;
    glimmer_scene *scene_;
    Materials result_;
    std::unordered_map<std::string, Value> values_;
    std::unordered_map<std::string, Added> added_;
    std::vector<std::string> open_; ///< the mixes that are being added, outermost first
};

} // namespace

uint32_t Materials::find(const Value &name) const {
    const auto found = indices.find(name.text());
    if (found == indices.end())
        refuse_name(name, "a material", "materials", names);
    return found->second;
}

Materials read_materials(const Value &materials, const Programs &programs, glimmer_scene *scene) {
    return MaterialReader(materials, programs, scene).read();
}

} // namespace glimmer
