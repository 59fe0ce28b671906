// SPDX-License-Identifier: GPL-3.0-or-later
// Materials: a caller's values by name, checked against the schema.
#include "api/handles.h"
#include "shading/material_schema.h"

#include <algorithm>
#include <string_view>

using namespace glimmer;

namespace {

constexpr size_t kMostParameters = 64;

std::string in_quotes(const char *word) {
    std::string out(1, '"');
    out += word;
    out += '"';
    return out;
}

template <class Range, class Name>
std::string list_of(const Range &items, const Name &name) {
    std::string out;
    for (const auto &item : items)
        out += (out.empty() ? "" : ", ") + std::string(name(item));
    return out;
}

MaterialType find_type(const char *type, const std::string &what) {
    const auto found =
        std::ranges::find_if(kMaterials, [&](const auto &m) { return type && std::string_view(m.type) == type; });
    if (found == kMaterials.end())
        fail_argument(what + ": type " + (type ? in_quotes(type) + " is not known" : "is null") +
                      "; allowed: " + list_of(kMaterials, [](const auto &m) { return m.type; }));
    return MaterialType(found - kMaterials.begin());
}

const ParameterRow &find_row(std::span<const ParameterRow> rows, const char *key, const std::string &what) {
    for (const ParameterRow &r : rows)
        if (key && std::string_view(r.info.key) == key)
            return r;
    fail_argument(what + (key ? " has no parameter " + in_quotes(key) : ": the key of a parameter is null") +
                  "; allowed: " + (rows.empty() ? "none" : list_of(rows, [](const auto &r) { return r.info.key; })));
}

void check_number(float value, const glimmer_parameter_info_t &info, const std::string &what) {
    const double x = double(value);
    if (std::isfinite(info.high))
        check_range(x, info.low, info.high, what);
    else if (!std::isfinite(x) || x < info.low || (info.above_low && x == info.low))
        fail_argument(what + " is " + text(x) + "; allowed: finite numbers " + (info.above_low ? "above " : "from ") +
                      text(info.low));
}

uint32_t find_word(const char *word, const glimmer_parameter_info_t &info, const std::string &what) {
    uint32_t number = 0;
    for (std::string_view rest = info.words; !rest.empty(); ++number) {
        const std::string_view next = rest.substr(0, rest.find(' '));
        if (word && next == word)
            return number;
        rest.remove_prefix(std::min(next.size() + 1, rest.size()));
    }
    std::string words = info.words;
    for (size_t i = 0; (i = words.find(' ', i)) != std::string::npos; i += 2)
        words.replace(i, 1, ", ");
    fail_argument(what + (word ? " is " + in_quotes(word) : " is null") + "; allowed: " + words);
}

void check_part(uint32_t part, const std::vector<MaterialDescription> &before, const std::string &what) {
    if (part >= before.size())
        fail_argument(what + ": material " + std::to_string(part) + " was not added before");
    const glimmer_material_info_t &info = kMaterials[size_t(before[part].type)];
    if (!info.mixable)
        fail_argument(what + ": " + info.type + " cannot be a part of another material");
}

/// Checks a value and puts it where it belongs.
struct Assign {
    const glimmer_parameter &from;
    const glimmer_parameter_info_t &info;
    const std::vector<MaterialDescription> &before;
    MaterialDescription &out;
    const std::string what;

    void operator()(float MaterialDescription::*member) const {
        check_number(from.value[0], info, what);
        out.*member = from.value[0];
    }
    void operator()(Rgb MaterialDescription::*member) const {
        for (const float v : from.value)
            check_number(v, info, what);
        out.*member = {from.value[0], from.value[1], from.value[2]};
    }
    void operator()(uint32_t MaterialDescription::*member) const {
        check_part(from.material, before, what);
        out.*member = from.material;
    }
    template <class Words>
    void operator()(Words MaterialDescription::*member) const {
        out.*member = Words(find_word(from.word, info, what));
    }
};

/// The required parameters of an alternative: "eta and k".
std::string required_of(std::span<const ParameterRow> rows, uint32_t alternative) {
    std::string out;
    for (const ParameterRow &r : rows)
        if (r.info.alternative == alternative && r.info.required)
            out += (out.empty() ? "" : " and ") + std::string(r.info.key);
    return out;
}

/// Which of the type's alternatives is given, by their required parameters; 0 where it has none.
uint32_t find_alternative(std::span<const ParameterRow> rows, std::span<const ParameterRow *const> given,
                          const std::string &what) {
    uint32_t count = 0, found = 0;
    for (const ParameterRow &r : rows)
        count = std::max(count, r.info.alternative);
    bool several = false;
    for (const ParameterRow *r : given)
        if (r->info.required && r->info.alternative) {
            several |= found != 0 && found != r->info.alternative;
            found = r->info.alternative;
        }
    if (count && (several || !found)) {
        std::string all;
        for (uint32_t n = 1; n <= count; ++n)
            all += (n == 1 ? "" : n == count ? ", or " : ", ") + required_of(rows, n);
        fail_argument(what + ": needs either " + all);
    }
    for (const ParameterRow *r : given)
        if (r->info.alternative && r->info.alternative != found)
            fail_argument(what + ": " + r->info.key + " goes with " + required_of(rows, r->info.alternative) +
                          ", not with " + required_of(rows, found));
    return found;
}

MaterialDescription read_material(const glimmer_material_desc &d, const std::vector<MaterialDescription> &before,
                                  const std::string &what) {
    MaterialDescription out;
    out.label = d.name ? d.name : "";
    out.type = find_type(d.type, what);
    if (d.parameter_count > kMostParameters || (d.parameter_count && !d.parameters))
        fail_argument(what + ": " + (d.parameters ? std::to_string(d.parameter_count) : "null") +
                      " parameters; allowed: up to " + std::to_string(kMostParameters));
    const std::span<const ParameterRow> rows = parameters_of(out.type);
    std::vector<const ParameterRow *> given;
    for (size_t i = 0; i < d.parameter_count; ++i) {
        const ParameterRow &row = find_row(rows, d.parameters[i].key, what + ": " + kMaterials[size_t(out.type)].type);
        if (std::ranges::find(given, &row) != given.end())
            fail_argument(what + ": " + row.info.key + " is given twice");
        given.push_back(&row);
        std::visit(Assign{d.parameters[i], row.info, before, out, what + ": " + row.info.key}, row.member);
    }
    out.alternative = find_alternative(rows, given, what);
    for (const ParameterRow &r : rows)
        if (r.info.required && (!r.info.alternative || r.info.alternative == out.alternative) &&
            std::ranges::find(given, &r) == given.end())
            fail_argument(what + ": the key " + in_quotes(r.info.key) + " is missing");
    return out;
}

} // namespace

extern "C" {

const glimmer_material_info_t *glimmer_material_info(uint32_t index) {
    return index < kMaterials.size() ? &kMaterials[index] : nullptr;
}

const glimmer_parameter_info_t *glimmer_parameter_info(uint32_t index) {
    return index < kParameters.size() ? &kParameters[index].info : nullptr;
}

void glimmer_material_init(glimmer_material_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
}

glimmer_result glimmer_scene_add_material(glimmer_scene *scene, const glimmer_material_desc *desc, uint32_t *material) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        glimmer_material_desc defaults;
        glimmer_material_init(&defaults);
        const glimmer_material_desc d = checked_desc(desc, defaults, "material");
        const std::string what = label_of("material", d.name);
        MaterialDescription out = read_material(d, s.materials, what);
        if (!material)
            fail_argument(what + ": the output is null");
        s.materials.push_back(std::move(out));
        *material = uint32_t(s.materials.size() - 1);
    });
}
}
