// SPDX-License-Identifier: GPL-3.0-or-later
// What the opaque handles of the C API hold, and the frame every call runs in.
#pragma once

#include "base/error.h"
#include "base/float_mode.h"
#include "geometry/mesh.h"
#include "render/session.h"
#include "scene/description.h"
#include "scene/scene.h"

#include <cmath>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <vector>

// A word at the start of every handle tells a null, foreign or destroyed one from a good one (as well as a pointer can
// be told).
struct glimmer_mesh {
    static constexpr uint32_t kMagic = 0x4d455348;
    uint32_t magic = kMagic;
    std::shared_ptr<glimmer::Mesh> mesh;
};

struct glimmer_image {
    static constexpr uint32_t kMagic = 0x494d4147;
    uint32_t magic = kMagic;
    std::shared_ptr<glimmer::Image> image;
};

struct glimmer_texture {
    static constexpr uint32_t kMagic = 0x54585452;
    uint32_t magic = kMagic;
    std::shared_ptr<const glimmer::Texture> texture;
};

struct glimmer_scene {
    static constexpr uint32_t kMagic = 0x5343454e;
    uint32_t magic = kMagic;
    glimmer::SceneDescription description; ///< emptied by commit
    std::shared_ptr<const glimmer::Scene> scene;
    std::string warnings;
};

struct glimmer_render {
    static constexpr uint32_t kMagic = 0x524e4452;
    uint32_t magic = kMagic;
    std::unique_ptr<glimmer::Session> session;
    std::string report;
    std::vector<uint8_t> state;
};

namespace glimmer {

/// Keeps `message` for glimmer_last_error on this thread.
glimmer_result keep_error(glimmer_result code, const char *message) noexcept;

/// Runs a call's body; whatever it throws becomes a result code and a message. No exception crosses the API.
template <class Body>
glimmer_result guarded(const Body &body) noexcept {
    const FloatMode mode;
    try {
        body();
        return GLIMMER_OK;
    } catch (const Error &e) {
        return keep_error(e.code, e.what());
    } catch (const std::bad_alloc &) {
        return keep_error(GLIMMER_OUT_OF_MEMORY, "out of memory");
    } catch (const std::length_error &) {
        return keep_error(GLIMMER_OUT_OF_MEMORY, "out of memory: an array would be too large");
    } catch (const std::system_error &) { // of std::thread alone
        return keep_error(GLIMMER_OUT_OF_MEMORY, "out of memory, or of threads");
    } catch (const std::exception &e) {
        return keep_error(GLIMMER_INTERNAL, e.what());
    } catch (...) {
        return keep_error(GLIMMER_INTERNAL, "an unknown failure");
    }
}

template <class Handle>
Handle &checked(Handle *handle, const char *what) {
    if (!handle)
        fail_argument(std::string(what) + " is null");
    if (handle->magic != Handle::kMagic)
        fail_argument(std::string(what) + " is not a " + what + ", or was destroyed");
    return *handle;
}

/// The description of a scene that can still change.
inline SceneDescription &open_scene(glimmer_scene *scene) {
    glimmer_scene &s = checked(scene, "scene");
    if (s.scene)
        fail_state("the scene is committed and cannot change; make a new one");
    return s.description;
}

template <class Handle>
void destroy(Handle *handle) noexcept {
    if (handle && handle->magic == Handle::kMagic) {
        handle->magic = 0;
        delete handle;
    }
}

/// Whether a caller's struct_size can be that of some version of Desc: one that cut a field in two is none.
template <class Desc>
bool known_size(size_t struct_size) {
    return struct_size >= alignof(Desc) && struct_size <= sizeof(Desc) && struct_size % alignof(Desc) == 0;
}

/// A description as this library knows it: what an older caller left out keeps its default.
template <class Desc>
Desc checked_desc(const Desc *desc, const Desc &defaults, const char *what) {
    if (!desc)
        fail_argument(std::string(what) + ": the description is null");
    if (!known_size<Desc>(desc->struct_size))
        fail_argument(std::string(what) + ": struct_size is " + std::to_string(desc->struct_size) + "; allowed: " +
                      std::to_string(sizeof(Desc)) + ", or less from an older header; fill it from the init function");
    Desc out = defaults;
    std::memcpy(static_cast<void *>(&out), desc, desc->struct_size);
    out.struct_size = sizeof(Desc);
    return out;
}

inline std::string label_of(const char *kind, const char *name) {
    return name && *name ? std::string(kind) + " \"" + name + "\"" : std::string(kind);
}

inline std::string text(double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", x);
    return buffer;
}

/// Throws unless low <= x <= high; NaN and, unless allowed by the bounds, infinity are refused.
inline void check_range(double x, double low, double high, const std::string &what) {
    if (!(x >= low && x <= high))
        fail_argument(what + " is " + text(x) + "; allowed: " + text(low) + " to " + text(high));
}

/// For what may be anything from `low` up but must be a number.
inline void check_least(double x, double low, const std::string &what) {
    if (!std::isfinite(x) || x < low)
        fail_argument(what + " is " + text(x) + "; allowed: finite numbers from " + text(low));
}

inline void check_finite(double x, const std::string &what) {
    if (!std::isfinite(x))
        fail_argument(what + " is " + text(x) + "; allowed: finite numbers");
}

inline void check_affine(const double *m, const std::string &what) {
    for (int i = 0; i < 16; ++i)
        check_finite(m[i], what);
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
        fail_argument(what + ": the last row must be 0 0 0 1");
}

/// Of a domain that is not allowed.
inline constexpr size_t kNoRows = ~size_t(0);

/// The attributes of something that has so many rows of each domain, or kNoRows. Throws Error.
std::vector<MeshAttribute> checked_attributes(size_t number, const glimmer_attribute *attributes,
                                              const std::array<size_t, 4> &rows_of_domain, const std::string &what);

} // namespace glimmer
