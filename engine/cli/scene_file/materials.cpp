// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"
#include "text.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace glimmer {
namespace {

constexpr std::string_view kTypeNames[] = {"lambert",      "mirror", "conductor", "glass",
                                           "report_metal", "mix",    "light",     "null"};
constexpr glimmer_material_type kTypes[] = {GLIMMER_LAMBERT,      GLIMMER_MIRROR, GLIMMER_CONDUCTOR, GLIMMER_GLASS,
                                            GLIMMER_REPORT_METAL, GLIMMER_MIX,    GLIMMER_LIGHT,     GLIMMER_NULL};

void copy(const Float3 &from, float (&to)[3]) {
    std::copy(from.begin(), from.end(), to);
}

/// Adds materials depth first, so that the engine gets the parts of a mix before the mix.
class MaterialReader {
  public:
    MaterialReader(const Value &table, glimmer_scene *scene) : table_(table), scene_(scene) {}

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
        glimmer_material_type type;
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
        if (added.type == GLIMMER_LIGHT || added.type == GLIMMER_GLASS || added.type == GLIMMER_NULL)
            part.fail("neither part of a mix may be light, glass or null");
        return added.index;
    }

    Added add(const Value &value, const std::string &name) {
        value.expect_table();
        glimmer_material_desc desc;
        glimmer_material_init(&desc);
        desc.name = name.c_str();
        desc.type = kTypes[one_of(value.at("type"), "a material type", "material types", kTypeNames)];
        fill(value, name, desc);
        if (const auto emission = value.find("emission"))
            copy(emission->color(kNonNegative), desc.emission);
        uint32_t index = 0;
        check(glimmer_scene_add_material(scene_, &desc, &index), value.where());
        return {index, desc.type};
    }

    void fill(const Value &value, const std::string &name, glimmer_material_desc &desc) {
        switch (desc.type) {
        case GLIMMER_LAMBERT:
            value.expect_object({"type", "albedo", "emission"});
            copy(value.at("albedo").color(kUnit), desc.color);
            break;
        case GLIMMER_MIRROR:
            value.expect_object({"type", "reflectance", "emission"});
            copy(value.at("reflectance").color(kUnit), desc.color);
            break;
        case GLIMMER_CONDUCTOR:
            value.expect_object({"type", "alpha", "eta", "k", "f0", "f90", "masking", "emission"});
            fill_conductor(value, desc);
            break;
        case GLIMMER_GLASS:
            value.expect_object({"type", "ior", "fresnel"});
            fill_glass(value, desc);
            break;
        case GLIMMER_REPORT_METAL:
            value.expect_object({"type", "albedo", "f0", "alpha", "emission"});
            copy(value.at("albedo").color(kUnit), desc.color);
            copy(value.at("f0").color(kUnit), desc.f0);
            desc.alpha = value.at("alpha").single(kUnit);
            break;
        case GLIMMER_MIX:
            value.expect_object({"type", "weight", "a", "b", "emission"});
            desc.weight = value.at("weight").single(kUnit);
            desc.a = add_part(value.at("a"), name + ".a");
            desc.b = add_part(value.at("b"), name + ".b");
            break;
        case GLIMMER_LIGHT:
            value.expect_object({"type", "radiance"});
            copy(value.at("radiance").color(kNonNegative), desc.color);
            break;
        case GLIMMER_NULL:
            value.expect_object({"type"});
            break;
        }
    }

    static void fill_conductor(const Value &value, glimmer_material_desc &desc) {
        constexpr std::string_view names[] = {"smith", "smith_separable", "schlick_ggx"};
        constexpr glimmer_masking maskings[] = {GLIMMER_SMITH, GLIMMER_SMITH_SEPARABLE, GLIMMER_SCHLICK_GGX};
        desc.alpha = value.at("alpha").single(kUnit);
        const bool has_eta = value.has("eta") || value.has("k");
        if (has_eta == value.has("f0"))
            value.fail("needs either eta and k, or f0");
        desc.use_f0 = !has_eta;
        if (has_eta) {
            copy(value.at("eta").color(kPositive), desc.eta);
            copy(value.at("k").color(kNonNegative), desc.k);
        } else {
            copy(value.at("f0").color(kUnit), desc.f0);
        }
        if (const auto f90 = value.find("f90")) {
            if (has_eta)
                value.fail("f90 goes with f0, not with eta and k");
            copy(f90->color(kUnit), desc.f90);
        }
        if (const auto masking = value.find("masking"))
            desc.masking = maskings[one_of(*masking, "a masking function", "masking functions", names)];
    }

    static void fill_glass(const Value &value, glimmer_material_desc &desc) {
        constexpr std::string_view names[] = {"exact", "schlick"};
        desc.ior = value.at("ior").single(kPositive);
        if (const auto fresnel = value.find("fresnel"))
            desc.schlick_fresnel = one_of(*fresnel, "a Fresnel function", "Fresnel functions", names) == 1;
    }

    const Value &table_;
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

Materials read_materials(const Value &materials, glimmer_scene *scene) {
    return MaterialReader(materials, scene).read();
}

} // namespace glimmer
