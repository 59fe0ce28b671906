// SPDX-License-Identifier: GPL-3.0-or-later
// Fuzzes the C API: the input spells a sequence of calls with good, null and foreign handles, in any order, and values
// from the edges of every range. Each call gives a result code, a failed one also a message of one line and nothing
// else. What the header makes the caller's duty is kept: arrays are as long as their counts say.
#include "fuzz.h"
#include "glimmer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fuzzer/FuzzedDataProvider.h>
#include <limits>
#include <string>
#include <vector>

namespace glimmer {
namespace {

constexpr size_t kMostElements = 12; // of the arrays handed in
constexpr uint32_t kMostSide = 40;   // pixels of the pictures rendered

class Caller {
  public:
    Caller(const uint8_t *data, size_t size) : in_(data, size) {}

    ~Caller() {
        for (auto *render : renders_)
            glimmer_render_destroy(render);
        for (auto *scene : scenes_)
            glimmer_scene_destroy(scene);
        for (auto *mesh : meshes_)
            glimmer_mesh_destroy(mesh);
        for (auto *image : images_)
            glimmer_image_destroy(image);
    }

    void run() {
        for (int calls = 0; calls < 200 && in_.remaining_bytes() > 0; ++calls)
            call();
    }

  private:
    // ---- values

    double number() {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        constexpr std::array<double, 20> edges{0,
                                               -0.0,
                                               1,
                                               -1,
                                               0.5,
                                               1e-30,
                                               1e-320,
                                               1e30,
                                               1e300,
                                               180,
                                               -1e5,
                                               1e-45,
                                               3e38,
                                               1e38,
                                               1e19,
                                               1e9,
                                               infinity,
                                               -infinity,
                                               std::numeric_limits<double>::quiet_NaN(),
                                               90};
        if (in_.ConsumeBool())
            return in_.PickValueInArray(edges);
        return in_.ConsumeFloatingPointInRange<double>(-4, 4);
    }
    float single() { return static_cast<float>(std::clamp(number(), -3.4e38, 3.4e38)); }
    template <class T>
    void fill(T *values, size_t count) {
        for (size_t i = 0; i < count; ++i)
            values[i] = static_cast<T>(in_.ConsumeIntegralInRange<int>(0, 7) ? single() : number());
    }
    uint32_t index() { return in_.ConsumeBool() ? in_.ConsumeIntegralInRange<uint32_t>(0, 8) : integer(); }
    uint32_t integer() {
        constexpr std::array<uint32_t, 8> edges{0, 1, 2, 3, 0x7fffffff, 0x80000000, 0xfffffff0, 0xffffffff};
        return in_.PickValueInArray(edges);
    }
    template <class E>
    E choice(int most) {
        int value = in_.ConsumeIntegralInRange<int>(-1, most + 1);
        E result;
        std::memcpy(&result, &value, sizeof result); // as a C caller can
        return result;
    }
    const char *name() {
        text_ = in_.ConsumeRandomLengthString(8);
        return in_.ConsumeBool() ? text_.c_str() : nullptr;
    }
    /// Mostly a rigid or a scaled matrix, so that what follows has a chance.
    void matrix(double *rows) {
        for (size_t i = 0; i < 16; ++i)
            rows[i] = i % 5 == 0 ? 1 : 0;
        const int kind = in_.ConsumeIntegralInRange<int>(0, 4);
        if (kind == 1)
            fill(rows, 16);
        for (size_t r = 0; kind >= 2 && r < 3; ++r)
            rows[4 * r + 3] = number();
        for (size_t r = 0; kind == 3 && r < 3; ++r)
            rows[5 * r] = number();
    }
    template <class Desc>
    void spoil_size(Desc &desc) {
        if (in_.ConsumeIntegralInRange<int>(0, 31) == 0)
            desc.struct_size = in_.ConsumeBool() ? in_.ConsumeIntegralInRange<size_t>(0, sizeof desc) : SIZE_MAX;
    }

    // ---- handles

    template <class Handle>
    Handle *any(const std::vector<Handle *> &good) {
        if (!good.empty() && in_.ConsumeIntegralInRange<int>(0, 15) != 0)
            return good[in_.ConsumeIntegralInRange<size_t>(0, good.size() - 1)];
        void *foreign = nullptr;
        switch (in_.ConsumeIntegralInRange<int>(0, 4)) {
        case 0:
            foreign = meshes_.empty() ? nullptr : meshes_.back();
            break;
        case 1:
            foreign = images_.empty() ? nullptr : images_.back();
            break;
        case 2:
            foreign = scenes_.empty() ? nullptr : scenes_.back();
            break;
        case 3:
            foreign = renders_.empty() ? nullptr : renders_.back();
            break;
        default:
            break;
        }
        return static_cast<Handle *>(foreign);
    }
    template <class Handle>
    void destroy(std::vector<Handle *> &good, void (*destroy_one)(Handle *)) {
        Handle *handle = any(good);
        const auto found = std::find(good.begin(), good.end(), handle);
        destroy_one(handle); // a foreign one stays as it is
        if (found != good.end())
            good.erase(found);
    }

    glimmer_result expect(glimmer_result result) {
        require(result >= GLIMMER_OK && result <= GLIMMER_UNAVAILABLE,
                result == GLIMMER_INTERNAL ? std::string("a defect: ") + glimmer_last_error() : "an unknown result");
        if (result != GLIMMER_OK)
            expect_one_line(glimmer_last_error());
        return result;
    }
    template <class Handle>
    void keep(glimmer_result result, Handle *handle, std::vector<Handle *> &good) {
        require((expect(result) == GLIMMER_OK) == (handle != nullptr),
                "a handle of a failed call, or none of a good one");
        if (handle)
            good.push_back(handle);
    }

    // ---- calls

    void create_mesh() {
        glimmer_mesh_desc desc;
        glimmer_mesh_init(&desc);
        std::array<double, 3 * kMostElements> doubles{}, normals{};
        std::array<float, 3 * kMostElements> floats{};
        std::array<uint32_t, 3 * kMostElements> triangles{};
        std::array<uint16_t, kMostElements> slots{};
        fill(doubles.data(), doubles.size());
        fill(floats.data(), floats.size());
        desc.name = name();
        desc.format = in_.ConsumeIntegralInRange<int>(0, 15) ? GLIMMER_FLOAT64 : choice<glimmer_format>(1);
        desc.vertex_count = in_.ConsumeIntegralInRange<size_t>(0, kMostElements);
        desc.vertices = doubles.data();
        desc.triangle_count = in_.ConsumeIntegralInRange<size_t>(0, kMostElements);
        for (uint32_t &vertex : triangles)
            vertex = in_.ConsumeIntegralInRange<uint32_t>(0, static_cast<uint32_t>(kMostElements));
        desc.triangles = triangles.data();
        if (in_.ConsumeBool()) {
            fill(normals.data(), normals.size());
            desc.normals = normals.data();
        }
        if (in_.ConsumeBool())
            desc.uvs = doubles.data();
        if (in_.ConsumeBool()) {
            for (uint16_t &slot : slots)
                slot = in_.ConsumeBool() ? in_.ConsumeIntegralInRange<uint16_t>(0, 2) : uint16_t(0xffff);
            desc.slots = slots.data();
        }
        if (desc.format == GLIMMER_FLOAT32)
            desc.vertices = floats.data(), desc.normals = nullptr, desc.uvs = nullptr;
        // Counts that no array has are refused before anyone reads one.
        constexpr std::array<size_t, 3> absurd{size_t(0xffffffff), size_t(1) << 62, SIZE_MAX};
        if (in_.ConsumeIntegralInRange<int>(0, 15) == 0)
            (in_.ConsumeBool() ? desc.vertex_count : desc.triangle_count) = in_.PickValueInArray(absurd);
        spoil_size(desc);
        glimmer_mesh *mesh = nullptr;
        keep(glimmer_mesh_create(&desc, &mesh), mesh, meshes_);
    }

    void create_image() {
        std::array<float, 4 * 4 * 4> pixels{};
        for (float &value : pixels)
            value = in_.ConsumeBool() ? single() : 0.5f;
        glimmer_image *image = nullptr;
        uint32_t width = in_.ConsumeIntegralInRange<uint32_t>(0, 4),
                 height = in_.ConsumeIntegralInRange<uint32_t>(0, 4);
        if (in_.ConsumeIntegralInRange<int>(0, 15) == 0)
            width = 65537, height = integer();
        keep(glimmer_image_create(width, height, in_.ConsumeIntegralInRange<uint32_t>(2, 5),
                                  in_.ConsumeIntegralInRange<int>(0, 15) ? pixels.data() : nullptr, &image),
             image, images_);
    }

    void create_scene() {
        glimmer_scene *scene = nullptr;
        keep(glimmer_scene_create(&scene), scene, scenes_);
        if (in_.ConsumeBool()) { // what every scene needs, so that there are whole ones
            set_camera(scene);
            set_film(scene);
            for (int i = 0; i < 3; ++i)
                add_material(scene);
        }
    }

    void add_material(glimmer_scene *scene) {
        glimmer_material_desc desc;
        glimmer_material_init(&desc);
        desc.name = name();
        desc.type = choice<glimmer_material_type>(GLIMMER_NULL);
        for (float *values : {desc.color, desc.eta, desc.k, desc.f0, desc.emission})
            if (in_.ConsumeIntegralInRange<int>(0, 3) == 0)
                fill(values, 3);
        desc.alpha = in_.ConsumeFloatingPointInRange<float>(-0.1f, 1.1f);
        desc.use_f0 = in_.ConsumeBool();
        desc.masking = choice<glimmer_masking>(GLIMMER_SCHLICK_GGX);
        if (in_.ConsumeBool())
            desc.ior = single();
        desc.schlick_fresnel = in_.ConsumeBool();
        desc.weight = in_.ConsumeFloatingPointInRange<float>(-0.1f, 1.1f);
        desc.a = index();
        desc.b = index();
        spoil_size(desc);
        uint32_t material = 0;
        expect(glimmer_scene_add_material(scene, &desc, &material));
    }

    void add_object(glimmer_scene *scene) {
        glimmer_object_desc desc;
        glimmer_object_init(&desc);
        std::array<uint32_t, 4> materials{}, indices{};
        std::array<double, 4 * 12> instances{};
        for (uint32_t &material : materials)
            material = index();
        desc.name = name();
        desc.mesh = any(meshes_);
        desc.material_count = in_.ConsumeIntegralInRange<size_t>(0, materials.size());
        desc.materials = materials.data();
        matrix(desc.to_world);
        if (in_.ConsumeBool()) {
            fill(instances.data(), instances.size());
            desc.instances = instances.data();
            desc.instance_count = in_.ConsumeIntegralInRange<size_t>(0, 4);
            desc.instance_format = in_.ConsumeIntegralInRange<int>(0, 7) ? GLIMMER_FLOAT64 : choice<glimmer_format>(1);
            desc.object_indices = in_.ConsumeBool() ? indices.data() : nullptr;
            if (in_.ConsumeIntegralInRange<int>(0, 31) == 0)
                desc.instance_count = SIZE_MAX;
        }
        spoil_size(desc);
        expect(glimmer_scene_add_object(scene, &desc));
    }

    void add_spheres(glimmer_scene *scene) {
        glimmer_spheres_desc desc;
        glimmer_spheres_init(&desc);
        std::array<double, 3 * kMostElements> centers{};
        std::array<double, kMostElements> radii{};
        fill(centers.data(), centers.size());
        for (double &radius : radii)
            radius = in_.ConsumeIntegralInRange<int>(0, 7) ? std::abs(number()) : number();
        desc.name = name();
        desc.count = in_.ConsumeIntegralInRange<size_t>(0, kMostElements);
        desc.centers = centers.data();
        desc.radius_count = in_.ConsumeBool() ? 1 : in_.ConsumeIntegralInRange<size_t>(0, kMostElements);
        desc.radii = radii.data();
        desc.material = index();
        if (in_.ConsumeIntegralInRange<int>(0, 31) == 0)
            desc.count = SIZE_MAX;
        spoil_size(desc);
        expect(glimmer_scene_add_spheres(scene, &desc));
    }

    void add_light(glimmer_scene *scene) {
        glimmer_light_desc desc;
        glimmer_light_init(&desc);
        desc.name = name();
        desc.type = choice<glimmer_light_type>(GLIMMER_AREA);
        if (in_.ConsumeBool())
            fill(desc.color, 3);
        if (in_.ConsumeBool())
            fill(desc.position, 3);
        if (in_.ConsumeBool())
            fill(desc.direction, 3);
        if (in_.ConsumeBool())
            fill(desc.size, 2);
        desc.radius = std::abs(number());
        desc.angle = number();
        desc.blend = in_.ConsumeFloatingPointInRange<double>(-0.1, 1.1);
        matrix(desc.to_world);
        desc.ellipse = in_.ConsumeBool();
        spoil_size(desc);
        expect(glimmer_scene_add_light(scene, &desc));
    }

    void set_environment(glimmer_scene *scene) {
        float color[3];
        double to_world[16];
        fill(color, 3);
        matrix(to_world);
        expect(glimmer_scene_set_environment(scene, color, in_.ConsumeBool() ? any(images_) : nullptr,
                                             in_.ConsumeBool() ? to_world : nullptr));
    }

    void set_medium(glimmer_scene *scene) {
        double sigma_a[3], sigma_s[3];
        for (size_t c = 0; c < 3; ++c) {
            sigma_a[c] = in_.ConsumeIntegralInRange<int>(0, 7) ? in_.ConsumeProbability<double>() : number();
            sigma_s[c] = in_.ConsumeIntegralInRange<int>(0, 7) ? in_.ConsumeProbability<double>() : number();
        }
        expect(glimmer_scene_set_medium(scene, sigma_a, sigma_s, in_.ConsumeFloatingPointInRange<double>(-1, 1)));
    }

    void set_camera(glimmer_scene *scene) {
        glimmer_camera_desc desc;
        glimmer_camera_init(&desc);
        matrix(desc.to_world);
        if (in_.ConsumeBool())
            desc.fov_x = number();
        if (in_.ConsumeBool())
            fill(desc.shift, 2);
        if (in_.ConsumeBool())
            desc.lens_radius = number(), desc.focus_distance = number();
        if (in_.ConsumeBool())
            desc.clip_start = number(), desc.clip_end = number();
        spoil_size(desc);
        expect(glimmer_scene_set_camera(scene, &desc));
    }

    void set_film(glimmer_scene *scene) {
        glimmer_film_desc desc;
        glimmer_film_init(&desc);
        // Always small, or refused: what takes gigabytes is another test's.
        desc.width = in_.ConsumeIntegralInRange<uint32_t>(0, kMostSide);
        desc.height = in_.ConsumeIntegralInRange<uint32_t>(0, kMostSide);
        if (in_.ConsumeIntegralInRange<int>(0, 15) == 0)
            (in_.ConsumeBool() ? desc.width : desc.height) = 65537;
        if (in_.ConsumeBool())
            for (uint32_t &edge : desc.crop)
                edge = in_.ConsumeBool() ? in_.ConsumeIntegralInRange<uint32_t>(0, kMostSide) : integer();
        desc.filter = choice<glimmer_filter>(GLIMMER_BLACKMAN_HARRIS);
        desc.filter_width = in_.ConsumeBool() ? 1.5f : single();
        expect(glimmer_scene_set_film(scene, &desc)); // of the size known, or the default's
    }

    void commit(glimmer_scene *scene) {
        if (expect(glimmer_scene_commit(scene, in_.ConsumeIntegralInRange<uint32_t>(0, 3))) == GLIMMER_OK)
            require(glimmer_scene_warnings(scene) != nullptr, "no warnings of a committed scene");
    }

    void create_render(glimmer_scene *scene) {
        glimmer_render_desc desc;
        glimmer_render_init(&desc);
        constexpr std::array<const char *, 4> integrators{"path", "report", "", "none"};
        desc.integrator = in_.PickValueInArray(integrators);
        desc.samples = in_.ConsumeIntegralInRange<uint64_t>(0, 5);
        desc.seconds = in_.ConsumeBool() ? 0.01 : number();
        desc.target_error = in_.ConsumeBool() ? 0 : number();
        desc.seed = in_.ConsumeIntegral<uint64_t>();
        desc.threads = in_.ConsumeIntegralInRange<uint32_t>(1, 3);
        desc.tile_size = in_.ConsumeBool() ? in_.ConsumeIntegralInRange<uint32_t>(0, 64) : 65537;
        desc.max_depth = in_.ConsumeIntegralInRange<int64_t>(-2, 4);
        desc.max_scatter = in_.ConsumeBool() ? -1 : INT64_MAX;
        desc.passes = in_.ConsumeIntegralInRange<uint32_t>(0, 1u << GLIMMER_PASS_COUNT);
        spoil_size(desc);
        glimmer_render *render = nullptr;
        keep(glimmer_render_create(scene, &desc, &render), render, renders_);
    }

    void read(glimmer_render *render) {
        std::vector<float> pixels(size_t(kMostSide) * kMostSide * 3, -7);
        const auto pass = choice<glimmer_pass>(GLIMMER_PASS_COUNT);
        uint32_t rectangle[4];
        for (uint32_t &edge : rectangle)
            edge =
                in_.ConsumeIntegralInRange<int>(0, 7) ? in_.ConsumeIntegralInRange<uint32_t>(0, kMostSide) : integer();
        const auto *info = glimmer_pass_info(static_cast<uint32_t>(pass));
        const size_t channels = info ? std::strlen(info->channels) : 1;
        const size_t count = in_.ConsumeIntegralInRange<int>(0, 7)
                                 ? size_t(rectangle[2]) * rectangle[3] * channels
                                 : in_.ConsumeIntegralInRange<size_t>(0, pixels.size());
        const glimmer_result result = expect(glimmer_render_read(render, pass, rectangle[0], rectangle[1], rectangle[2],
                                                                 rectangle[3], pixels.data(), count));
        for (size_t i = result == GLIMMER_OK ? count : 0; i < pixels.size(); ++i)
            require(pixels[i] == -7, "a value beyond the rectangle, or of a failed call");
    }

    void save(glimmer_render *render) {
        const void *data = nullptr;
        size_t size = 0;
        if (expect(glimmer_render_save(render, &data, &size)) == GLIMMER_OK)
            state_.assign(static_cast<const char *>(data), size);
    }

    void load(glimmer_render *render) {
        std::string state = state_;
        if (in_.ConsumeBool())
            state.resize(in_.ConsumeIntegralInRange<size_t>(0, state.size() + 8));
        for (int i = in_.ConsumeIntegralInRange<int>(0, 3); i > 0 && !state.empty(); --i)
            state[in_.ConsumeIntegralInRange<size_t>(0, std::min<size_t>(state.size(), 512) - 1)] =
                in_.ConsumeIntegral<char>();
        expect(
            glimmer_render_load(render, in_.ConsumeIntegralInRange<int>(0, 15) ? state.data() : nullptr, state.size()));
    }

    void control(glimmer_render *render) {
        switch (in_.ConsumeIntegralInRange<int>(0, 7)) {
        case 0:
        case 1:
            expect(glimmer_render_start(render));
            break;
        case 2:
            expect(glimmer_render_pause(render));
            break;
        case 3:
            expect(glimmer_render_resume(render));
            break;
        case 4:
            expect(glimmer_render_cancel(render));
            break;
        case 5: {
            constexpr std::array<double, 4> waits{0, 0.001, 0.01, -0.0};
            expect(glimmer_render_wait(render, in_.PickValueInArray(waits)));
            break;
        }
        case 6: {
            glimmer_progress progress;
            glimmer_progress_init(&progress);
            spoil_size(progress);
            expect(glimmer_render_poll(render, &progress));
            break;
        }
        default: {
            glimmer_tile tile;
            int found = 0;
            expect(glimmer_render_next_tile(render, &tile, &found));
        }
        }
    }

    void report(glimmer_render *render) {
        const char *json = nullptr;
        if (expect(glimmer_render_report(render, &json)) == GLIMMER_OK)
            require(json && *json == '{', "a report that is none");
    }

    void call() {
        switch (in_.ConsumeIntegralInRange<int>(0, 20)) {
        case 0:
            return create_mesh();
        case 1:
            return create_image();
        case 2:
            return create_scene();
        case 3:
            return add_material(any(scenes_));
        case 4:
        case 5:
            return add_object(any(scenes_));
        case 6:
        case 7:
            return add_spheres(any(scenes_));
        case 8:
            return add_light(any(scenes_));
        case 9:
            return set_environment(any(scenes_));
        case 10:
            return set_medium(any(scenes_));
        case 11:
            return set_camera(any(scenes_));
        case 12:
            return set_film(any(scenes_));
        case 13:
            return commit(any(scenes_));
        case 14:
            return create_render(any(scenes_));
        case 15:
            return read(any(renders_));
        case 16:
            return save(any(renders_));
        case 17:
            return load(any(renders_));
        case 18:
            return report(any(renders_));
        case 19:
            return control(any(renders_));
        default:
            break;
        }
        switch (in_.ConsumeIntegralInRange<int>(0, 7)) {
        case 0:
            return destroy(meshes_, glimmer_mesh_destroy);
        case 1:
            return destroy(images_, glimmer_image_destroy);
        case 2:
            return destroy(scenes_, glimmer_scene_destroy);
        case 3:
            return destroy(renders_, glimmer_render_destroy);
        default:
            return control(any(renders_));
        }
    }

    FuzzedDataProvider in_;
    std::vector<glimmer_mesh *> meshes_;
    std::vector<glimmer_image *> images_;
    std::vector<glimmer_scene *> scenes_;
    std::vector<glimmer_render *> renders_;
    std::string text_, state_;
};

} // namespace
} // namespace glimmer

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    glimmer::expect_no_leak([&] { glimmer::Caller(data, size).run(); });
    return 0;
}
