// SPDX-License-Identifier: GPL-3.0-or-later
// The check of shader programs: after it, evaluation needs none.
#include "shading/program.h"

#include "base/error.h"

#include <cmath>
#include <cstring>
#include <string_view>

namespace glimmer {

namespace {

void check_count(size_t count, size_t most, const void *data, const std::string &what) {
    if (count > most)
        fail_argument(what + " are " + std::to_string(count) + "; allowed: up to " + std::to_string(most));
    if (count && !data)
        fail_argument(what + " are null");
}

/// How many words the field of a mode has; 0: there is no such field.
size_t words_of_field(std::string_view modes, size_t field) {
    for (; field > 0; --field) {
        const size_t bar = modes.find('|');
        if (bar == std::string_view::npos)
            return 0;
        modes.remove_prefix(bar + 1);
    }
    modes = modes.substr(0, modes.find('|'));
    size_t count = modes.empty() ? 0 : 1;
    for (char c : modes)
        count += c == ' ';
    return count;
}

/// What the registers hold, as far as the instructions before have written them.
struct Registers {
    enum class Kind : uint8_t { none, number, vector };
    std::array<Kind, Program::kMostRegisters> kinds{};
    size_t constant_count;

    void check(uint16_t operand, char wanted, const std::string &what) const {
        if (operand & GLIMMER_CONSTANT) {
            if (size_t(operand & ~GLIMMER_CONSTANT) >= constant_count)
                fail_argument(what + " is constant " + std::to_string(operand & ~GLIMMER_CONSTANT) + " of " +
                              std::to_string(constant_count));
            return;
        }
        if (operand >= kinds.size() || kinds[operand] == Kind::none)
            fail_argument(what + " is register " + std::to_string(operand) + ", which nothing has written");
        if ((kinds[operand] == Kind::number) != (wanted == 'n'))
            fail_argument(what + " is a " +
                          (wanted == 'n' ? "vector; allowed: a number" : "number; allowed: a vector"));
    }
};

/// The number of a mode's word in its first field.
size_t number_of(std::string_view modes, std::string_view word) {
    const std::string_view before = modes.substr(0, modes.find(word));
    return size_t(std::ranges::count(before, ' '));
}

void check_modes(const Instruction &i, const glimmer_op_info_t &info, const std::string &what) {
    for (size_t field = 0; field < std::size(i.mode); ++field) {
        const size_t words = std::max(words_of_field(info.modes, field), size_t(1));
        if (i.mode[field] >= words)
            fail_argument(what + ": mode " + std::to_string(field) + " is " + std::to_string(i.mode[field]) +
                          "; allowed: 0 to " + std::to_string(words - 1));
    }
}

bool asks_the_place(Op op) {
    switch (op) {
    case Op::geometry:
    case Op::geometry_number:
    case Op::attribute:
    case Op::attribute_alpha:
    case Op::fresnel:
    case Op::layer_weight:
    case Op::bump:
    case Op::normal_map:
    case Op::tangent:
    case Op::wireframe:
    case Op::vector_transform:
        return true;
    default:
        return false;
    }
}

} // namespace

Program::Program(const glimmer_program_desc &desc, std::vector<std::shared_ptr<const Texture>> textures)
    : name(desc.name ? desc.name : ""), textures_(std::move(textures)) {
    check(desc);
}

void Program::check_tables(const glimmer_program_desc &desc, const std::string &what) {
    check_count(desc.table_count, kMostResources, desc.tables, what + ": tables");
    for (size_t t = 0; t < desc.table_count; ++t) {
        const glimmer_table &table = desc.tables[t];
        const std::string which = what + ": table " + std::to_string(t);
        check_count(table.row_count, kMostRows, table.rows, which + ": rows");
        if (table.row_count < 2)
            fail_argument(which + " has " + std::to_string(table.row_count) + " row(s); allowed: 2 to 65536");
        if (!(std::isfinite(table.low) && std::isfinite(table.high) && table.low < table.high))
            fail_argument(which + ": its interval is empty or not finite");
        ColorTable out;
        out.low = table.low;
        out.high = table.high;
        for (size_t i = 0; i < table.row_count; ++i) {
            std::array<float, 4> row{};
            for (size_t c = 0; c < 4; ++c) {
                row[c] = table.rows[4 * i + c];
                if (!std::isfinite(row[c]))
                    fail_argument(which + ": row " + std::to_string(i) + " is not finite");
            }
            out.rows.push_back(row);
        }
        tables_.push_back(std::move(out));
    }
}

void Program::check(const glimmer_program_desc &desc) {
    const std::string what = name.empty() ? "program" : "program \"" + name + "\"";
    check_count(desc.instruction_count, kMostInstructions, desc.instructions, what + ": instructions");
    check_count(desc.constant_count, kMostConstants, desc.constants, what + ": constants");
    check_count(desc.attribute_count, kMostResources, desc.attributes, what + ": attributes");
    check_count(desc.output_count, kMostOutputs, desc.outputs, what + ": outputs");
    if (desc.output_count == 0)
        fail_argument(what + " has no outputs; allowed: 1 to " + std::to_string(kMostOutputs));
    for (size_t i = 0; i < 3 * desc.constant_count; ++i)
        if (!std::isfinite(desc.constants[i]))
            fail_argument(what + ": constant " + std::to_string(i / 3) + " is not finite");
    for (size_t i = 0; i < desc.constant_count; ++i)
        constants_.emplace_back(desc.constants[3 * i], desc.constants[3 * i + 1], desc.constants[3 * i + 2]);
    check_tables(desc, what);
    for (size_t i = 0; i < desc.attribute_count; ++i) {
        if (!desc.attributes[i])
            fail_argument(what + ": attribute " + std::to_string(i) + " is null");
        attribute_names_.emplace_back(desc.attributes[i]);
    }

    Registers registers;
    registers.constant_count = constants_.size();
    for (size_t k = 0; k < desc.instruction_count; ++k) {
        const Instruction &i = desc.instructions[k];
        std::string where = what + ": instruction " + std::to_string(k);
        if (i.op >= kOps.size())
            fail_argument(where + ": op " + std::to_string(i.op) + " is not known; allowed: 0 to " +
                          std::to_string(kOps.size() - 1));
        const glimmer_op_info_t &info = kOps[i.op];
        where += std::string(" (") + info.name + ")";
        check_modes(i, info, where);
        for (size_t n = 0; info.inputs[n]; ++n)
            registers.check(i.in[n], info.inputs[n], where + ": input " + std::to_string(n));
        const size_t resources = info.resource == 't'   ? tables_.size()
                                 : info.resource == 'i' ? textures_.size()
                                 : info.resource == 'a' ? attribute_names_.size()
                                                        : 1;
        if (i.resource >= resources)
            fail_argument(where + ": " +
                          (info.resource == 't'   ? "table "
                           : info.resource == 'i' ? "texture "
                           : info.resource == 'a' ? "attribute "
                                                  : "resource ") +
                          std::to_string(i.resource) + " of " + std::to_string(resources));
        if (i.out >= kMostRegisters)
            fail_argument(where + ": output is register " + std::to_string(i.out) + "; allowed: 0 to " +
                          std::to_string(kMostRegisters - 1));
        registers.kinds[i.out] = info.output == 'n' ? Registers::Kind::number : Registers::Kind::vector;
        const bool box = (Op(i.op) == Op::image || Op(i.op) == Op::image_alpha) && i.mode[0] == 1;
        asks_ray_length_ |= Op(i.op) == Op::geometry_number && i.mode[0] == number_of(info.modes, "ray_length");
        constant_ = constant_ && !asks_the_place(Op(i.op)) && !box;
        instructions_.push_back(i);
    }
    for (size_t o = 0; o < desc.output_count; ++o) {
        const uint16_t out = desc.outputs[o];
        if (out >= kMostRegisters || registers.kinds[out] == Registers::Kind::none)
            fail_argument(what + ": output " + std::to_string(o) + " is register " + std::to_string(out) +
                          ", which nothing has written");
        outputs_.push_back(out);
        number_outputs_.push_back(registers.kinds[out] == Registers::Kind::number);
    }
}

size_t Program::size() const {
    size_t bytes = instructions_.size() * sizeof(Instruction) + constants_.size() * sizeof(Vec3f);
    for (const ColorTable &table : tables_)
        bytes += table.rows.size() * sizeof(table.rows[0]);
    return bytes;
}

} // namespace glimmer
