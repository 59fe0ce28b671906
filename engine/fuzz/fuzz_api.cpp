// SPDX-License-Identifier: GPL-3.0-or-later
// Fuzzes the C API: the input spells a sequence of calls with good, null and foreign handles, in any order, and values
// from the edges of every range. Each call gives a result code, a failed one also a message of one line and nothing
// else.
#include "api/calls.h"

namespace glimmer {
namespace {

/// Plots of one input: each takes as long as a hundred other calls.
constexpr int kMostPlots = 2;

/// One of them.
void call(Input &in, Handles &handles, std::string &state, int &plots) {
    switch (in.ConsumeIntegralInRange<int>(0, 21)) {
    case 0:
        return create_mesh(in, handles);
    case 1:
        return create_image(in, handles);
    case 2:
        return create_scene(in, handles);
    case 3:
        return add_material(in, handles.any(handles.scenes));
    case 4:
    case 5:
        return add_object(in, handles, handles.any(handles.scenes));
    case 6:
    case 7:
        return add_spheres(in, handles.any(handles.scenes));
    case 8:
        return add_light(in, handles.any(handles.scenes));
    case 9:
        return set_environment(in, handles, handles.any(handles.scenes));
    case 10:
        return set_medium(in, handles.any(handles.scenes));
    case 11:
        return set_camera(in, handles.any(handles.scenes));
    case 12:
        return set_film(in, handles.any(handles.scenes));
    case 13:
        return commit(in, handles.any(handles.scenes));
    case 14:
        return create_render(in, handles, handles.any(handles.scenes));
    case 15:
        return read(in, handles.any(handles.renders));
    case 16:
        return save(handles.any(handles.renders), state);
    case 17:
        return load(in, handles.any(handles.renders), state);
    case 18:
        return report(handles.any(handles.renders));
    case 19:
        return control(in, handles.any(handles.renders));
    case 20:
        if (++plots > kMostPlots)
            break;
        return draw_error_curve(in);
    default:
        break;
    }
    switch (in.ConsumeIntegralInRange<int>(0, 7)) {
    case 0:
        return handles.destroy(handles.meshes, glimmer_mesh_destroy);
    case 1:
        return handles.destroy(handles.images, glimmer_image_destroy);
    case 2:
        return handles.destroy(handles.scenes, glimmer_scene_destroy);
    case 3:
        return handles.destroy(handles.renders, glimmer_render_destroy);
    default:
        return control(in, handles.any(handles.renders));
    }
}

void call_on(const uint8_t *data, size_t size) {
    Input in(data, size);
    Handles handles(in);
    std::string state; // the last one that was saved
    int plots = 0;
    for (int calls = 0; calls < 200 && in.remaining_bytes() > 0; ++calls)
        call(in, handles, state, plots);
}

} // namespace
} // namespace glimmer

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    glimmer::expect_no_leak([&] { glimmer::call_on(data, size); });
    return 0;
}
