// SPDX-License-Identifier: GPL-3.0-or-later
// The calls of the C API, each with arguments that the input spells. What the header makes the caller's duty is kept:
// arrays are as long as their counts say.
#pragma once

#include "api/handles.h"

namespace glimmer {

// Those that make meshes and images.
void create_mesh(Input &in, Handles &handles);
void create_image(Input &in, Handles &handles);

// Those that fill and commit a scene.
void create_scene(Input &in, Handles &handles);
void add_material(Input &in, glimmer_scene *scene);
void add_object(Input &in, Handles &handles, glimmer_scene *scene);
void add_spheres(Input &in, glimmer_scene *scene);
void add_light(Input &in, glimmer_scene *scene);
void set_environment(Input &in, Handles &handles, glimmer_scene *scene);
void set_medium(Input &in, glimmer_scene *scene);
void set_camera(Input &in, glimmer_scene *scene);
void set_film(Input &in, glimmer_scene *scene);
void commit(Input &in, glimmer_scene *scene);

// Those that make, run and read a render.
void create_render(Input &in, Handles &handles, glimmer_scene *scene);
void read(Input &in, glimmer_render *render);
void save(glimmer_render *render, std::string &state);
void load(Input &in, glimmer_render *render, const std::string &saved);
void control(Input &in, glimmer_render *render);
void report(glimmer_render *render);

// The table and the plot of a curve.
void draw_error_curve(Input &in);

} // namespace glimmer
