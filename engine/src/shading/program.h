// SPDX-License-Identifier: GPL-3.0-or-later
// Shader programs: what varies over a surface or a sky, as straight-line code over registers. A node tree becomes one
// program, whose outputs are parameters of materials.
#pragma once

#include "glimmer.h"
#include "shading/ops.h"
#include "shading/shader_globals.h"
#include "shading/texture.h"

#include <memory>
#include <string>
#include <vector>

namespace glimmer {

using Instruction = glimmer_instruction;

/// Colours over an interval, sampled at equal steps.
struct ColorTable {
    std::vector<std::array<float, 4>> rows;
    float low = 0, high = 1;
};

/// What is larger among the values of programs is cut to this, so that products of them stay finite.
inline constexpr float kMostOfPrograms = 1e30f;

class Program {
  public:
    static constexpr size_t kMostInstructions = 4096, kMostRegisters = 256, kMostConstants = 8192, kMostResources = 256,
                            kMostOutputs = 64, kMostRows = 65536;

    /// Checks a description whole. Throws Error.
    explicit Program(const glimmer_program_desc &desc, std::vector<std::shared_ptr<const Texture>> textures);

    /// outputs: output_count() of them.
    [[gnu::noinline]] void evaluate(const ShaderGlobals &globals, Vec3f *outputs) const;

    size_t output_count() const { return outputs_.size(); }
    bool is_number(size_t output) const { return number_outputs_[output]; }
    /// Whether no instruction asks anything about the place.
    bool is_constant() const { return constant_; }
    /// Whether an instruction asks how long the ray was that meets the place.
    bool asks_ray_length() const { return asks_ray_length_; }
    const std::vector<std::string> &attribute_names() const { return attribute_names_; }
    /// The scene's numbers of the attributes' names, in their order.
    void set_attribute_ids(std::vector<uint32_t> ids) { attribute_ids_ = std::move(ids); }
    const std::vector<std::shared_ptr<const Texture>> &textures() const { return textures_; }
    size_t size() const;

    const std::string name;

  private:
    void check(const glimmer_program_desc &desc);
    void check_tables(const glimmer_program_desc &desc, const std::string &what);
    friend class Evaluation;

    std::vector<Instruction> instructions_;
    std::vector<Vec3f> constants_;
    std::vector<ColorTable> tables_;
    std::vector<std::shared_ptr<const Texture>> textures_;
    std::vector<std::string> attribute_names_;
    std::vector<uint32_t> attribute_ids_;
    std::vector<uint16_t> outputs_;
    std::vector<bool> number_outputs_;
    bool constant_ = true, asks_ray_length_ = false;
};

} // namespace glimmer
