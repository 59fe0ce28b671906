// SPDX-License-Identifier: GPL-3.0-or-later
// Textures and shader programs.
#include "arrays.h"
#include "parts.h"
#include "text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <deque>

namespace glimmer {
namespace {

std::vector<std::string_view> split(std::string_view text, char by) {
    std::vector<std::string_view> parts;
    for (size_t end; (end = text.find(by)) != std::string_view::npos; text.remove_prefix(end + 1))
        parts.push_back(text.substr(0, end));
    parts.push_back(text);
    return parts;
}

TextureHandle read_texture(const std::string &name, const Value &value, SceneFolder &folder) {
    value.expect_object({"file", "srgb"});
    const Value file_value = value.at("file");
    const auto file = folder.read(file_value);
    const std::string where = file_value.where() + ": " + in_quotes(file.name);
    const NpyArray array = parse_npy(file.bytes, where);
    if (array.shape.size() != 3 || array.shape[2] < 1 || array.shape[2] > 4)
        throw InputError(where + ": shape " + array.shape_text() + " is not (height, width, 1 to 4)");
    const bool bytes = array.dtype == "|u1";
    if (!bytes && !array.is_float())
        throw InputError(where + ": dtype " + in_quotes(array.dtype) + " is not uint8 or a float type");
    for (size_t extent : array.shape)
        if (extent > 65536)
            throw InputError(where + ": shape " + array.shape_text() + " is larger than 65536 on a side");
    const std::vector<uint8_t> texels(array.integers.begin(), array.integers.end());
    const std::vector<float> floats(array.values.begin(), array.values.end());
    glimmer_texture_desc desc;
    glimmer_texture_init(&desc);
    desc.name = name.c_str();
    desc.height = uint32_t(array.shape[0]);
    desc.width = uint32_t(array.shape[1]);
    desc.channels = uint32_t(array.shape[2]);
    desc.format = bytes ? GLIMMER_TEXEL_UINT8 : GLIMMER_TEXEL_FLOAT32;
    desc.pixels = bytes ? static_cast<const void *>(texels.data()) : floats.data();
    if (const auto srgb = value.find("srgb")) {
        if (!srgb->json().is_boolean())
            srgb->refuse("true or false");
        desc.srgb = srgb->json().get<bool>();
    }
    glimmer_texture *handle = nullptr;
    check(glimmer_texture_create(&desc, &handle), where);
    return TextureHandle(handle);
}

/// An operation of the engine's table.
struct Operation {
    uint16_t number;
    const glimmer_op_info_t *info;
    std::vector<std::vector<std::string_view>> modes;
};

struct Operations {
    std::vector<std::string_view> names;
    std::vector<Operation> rows;

    Operations() {
        for (uint32_t i = 0; const auto *info = glimmer_op_info(i); ++i) {
            names.emplace_back(info->name);
            rows.push_back({uint16_t(i), info, {}});
            if (*info->modes)
                for (std::string_view field : split(info->modes, '|'))
                    rows.back().modes.push_back(split(field, ' '));
        }
    }
};

class ProgramReader {
  public:
    ProgramReader(const Operations &operations, const Textures &textures, SceneFolder &folder)
        : operations_(operations), textures_(textures), folder_(folder) {}

    uint32_t read(const std::string &name, const Value &value, glimmer_scene *scene) {
        value.expect_object({"steps", "outputs"});
        value.at("steps").for_each([&](const Value &step) { read_step(step); });
        std::vector<uint16_t> outputs;
        value.at("outputs").for_each([&](const Value &output) { outputs.push_back(read_register(output)); });
        std::vector<glimmer_table> tables;
        for (const Table &table : tables_)
            tables.push_back({table.rows.size() / 4, table.rows.data(), table.low, table.high});
        std::vector<const char *> attributes;
        for (const std::string &attribute : attributes_)
            attributes.push_back(attribute.c_str());
        glimmer_program_desc desc;
        glimmer_program_init(&desc);
        desc.name = name.c_str();
        desc.instruction_count = steps_.size();
        desc.instructions = steps_.data();
        desc.constant_count = constants_.size() / 3;
        desc.constants = constants_.data();
        desc.table_count = tables.size();
        desc.tables = tables.data();
        desc.texture_count = used_textures_.size();
        desc.textures = used_textures_.data();
        desc.attribute_count = attributes.size();
        desc.attributes = attributes.data();
        desc.output_count = outputs.size();
        desc.outputs = outputs.data();
        uint32_t number = 0;
        check(glimmer_scene_add_program(scene, &desc, &number), value.where());
        return number;
    }

  private:
    struct Table {
        std::vector<float> rows;
        float low, high;
    };

    static uint16_t read_register(const Value &value) {
        const std::string text = value.json().is_string() ? value.text() : "";
        unsigned number = 0;
        const char *end = text.data() + text.size();
        const auto parsed = text.size() > 1 ? std::from_chars(text.data() + 1, end, number)
                                            : std::from_chars_result{text.data(), std::errc::invalid_argument};
        if (text.empty() || text[0] != 'r' || parsed.ec != std::errc() || parsed.ptr != end || number > 255)
            value.refuse("a register, \"r0\" to \"r255\"");
        return uint16_t(number);
    }

    uint16_t read_input(const Value &value, bool number) {
        if (value.json().is_string())
            return read_register(value);
        Float3 constant{};
        if (number)
            constant[0] = value.single();
        else
            constant = value.color(kAny);
        constants_.insert(constants_.end(), constant.begin(), constant.end());
        const size_t index = constants_.size() / 3 - 1;
        if (index >= GLIMMER_CONSTANT)
            value.fail("the program has more than " + std::to_string(GLIMMER_CONSTANT) + " constants");
        return uint16_t(GLIMMER_CONSTANT + index);
    }

    void read_step(const Value &value) {
        value.expect_object({"op", "modes", "in", "out", "table", "texture", "attribute"});
        const Operation &operation =
            operations_.rows[one_of(value.at("op"), "an operation", "operations", operations_.names)];
        glimmer_instruction step{};
        step.op = operation.number;
        read_modes(value, operation, step);
        const std::string_view kinds = operation.info->inputs;
        if (const auto inputs = value.find("in")) {
            inputs->expect_size(kinds.size());
            size_t n = 0;
            inputs->for_each([&](const Value &input) {
                step.in[n] = read_input(input, kinds[n] == 'n');
                ++n;
            });
        } else if (!kinds.empty()) {
            value.at("in");
        }
        step.out = read_register(value.at("out"));
        step.resource = read_resource(value, operation.info->resource);
        steps_.push_back(step);
    }

    static void read_modes(const Value &value, const Operation &operation, glimmer_instruction &step) {
        const auto modes = value.find("modes");
        if (!modes)
            return;
        if (modes->json().is_array() && modes->json().size() > operation.modes.size())
            modes->fail("has more words than the " + std::to_string(operation.modes.size()) + " that " +
                        in_quotes(operation.info->name) + " takes");
        size_t field = 0;
        modes->for_each([&](const Value &word) {
            step.mode[field] = uint8_t(one_of(word, "a mode of it", "modes", operation.modes[field]));
            ++field;
        });
    }

    uint16_t read_resource(const Value &value, char kind) {
        static constexpr std::pair<char, const char *> kKeys[] = {{'t', "table"}, {'i', "texture"}, {'a', "attribute"}};
        for (const auto &[own, key] : kKeys)
            if (const auto extra = value.find(key); extra && own != kind)
                extra->fail("is nothing that this operation takes");
        switch (kind) {
        case 't':
            return add_table(value.at("table"));
        case 'i': {
            used_textures_.push_back(textures_.find(value.at("texture")));
            return checked(used_textures_.size(), value);
        }
        case 'a':
            attributes_.push_back(value.at("attribute").text());
            return checked(attributes_.size(), value);
        default:
            return 0;
        }
    }

    uint16_t add_table(const Value &value) {
        value.expect_object({"rows", "low", "high"});
        const std::vector<double> rows = read_float_array(value.at("rows"), 4, folder_);
        Table table{{rows.begin(), rows.end()}, 0, 1};
        if (const auto low = value.find("low"))
            table.low = low->single();
        if (const auto high = value.find("high"))
            table.high = high->single();
        tables_.push_back(std::move(table));
        return checked(tables_.size(), value);
    }

    /// The number of the last of so many resources.
    static uint16_t checked(size_t count, const Value &value) {
        if (count > UINT16_MAX)
            value.fail("the program has too many of these");
        return uint16_t(count - 1);
    }

    const Operations &operations_;
    const Textures &textures_;
    SceneFolder &folder_;
    std::vector<glimmer_instruction> steps_;
    std::vector<float> constants_;
    std::deque<Table> tables_;
    std::vector<glimmer_texture *> used_textures_;
    std::deque<std::string> attributes_;
};

} // namespace

glimmer_texture *Textures::find(const Value &name) const {
    const auto found = handles.find(name.text());
    if (found == handles.end())
        refuse_name(name, "a texture", "textures", names);
    return found->second.get();
}

Textures read_textures(const Value &table, SceneFolder &folder) {
    Textures textures;
    table.for_each_named([&](const std::string &name, const Value &value) {
        textures.names.push_back(name);
        textures.handles.emplace(name, read_texture(name, value, folder));
    });
    return textures;
}

Programs read_programs(const Value &table, const Textures &textures, glimmer_scene *scene, SceneFolder &folder) {
    const Operations operations;
    Programs programs;
    table.for_each_named([&](const std::string &name, const Value &value) {
        programs.names.push_back(name);
        programs.numbers.emplace(name, ProgramReader(operations, textures, folder).read(name, value, scene));
    });
    return programs;
}

bool is_binding(const Value &value) {
    return value.json().is_object() && value.has("program");
}

Binding Programs::read_binding(const Value &value) const {
    value.expect_object({"program", "output"});
    const Value name = value.at("program");
    const auto found = numbers.find(name.text());
    if (found == numbers.end())
        refuse_name(name, "a program", "programs", names);
    const auto output = value.find("output");
    return {found->second, output ? uint32_t(output->integer(0, UINT32_MAX)) : 0};
}

} // namespace glimmer
