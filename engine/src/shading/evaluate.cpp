// SPDX-License-Identifier: GPL-3.0-or-later
// The interpreter of shader programs: one step an instruction, no jumps.
#include "shading/nodes/color.h"
#include "shading/nodes/gabor.h"
#include "shading/nodes/grid.h"
#include "shading/nodes/image.h"
#include "shading/nodes/normal.h"
#include "shading/nodes/pattern.h"
#include "shading/nodes/voronoi.h"
#include "shading/program.h"

namespace glimmer {

namespace {

using namespace nodes;

Vec3f times(const std::array<Vec3f, 3> &rows, const Vec3f &v) {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}
Vec3f times_transposed(const std::array<Vec3f, 3> &rows, const Vec3f &v) {
    return rows[0] * v.x + rows[1] * v.y + rows[2] * v.z;
}

Vec3f gray(float x) {
    return {x, x, x};
}

std::array<float, 4> row_at(const ColorTable &table, float x, bool constant, bool extrapolate) {
    const auto &rows = table.rows;
    const float last = float(rows.size() - 1);
    const float t = (x - table.low) / (table.high - table.low);
    std::array<float, 4> out{};
    if (extrapolate && (t < 0 || t > 1)) {
        const auto &end = t < 0 ? rows.front() : rows.back(), &inner = t < 0 ? rows[1] : rows[rows.size() - 2];
        const float beyond = (t < 0 ? -t : t - 1) * last;
        for (size_t c = 0; c < 4; ++c)
            out[c] = end[c] + (end[c] - inner[c]) * beyond;
        return out;
    }
    const float at = t > 0 ? std::min(t, 1.0f) * last : 0.0f; // NaN goes to the first row
    const auto low = std::min(size_t(at), rows.size() - 1);
    const float rest = constant || low + 1 == rows.size() ? 0.0f : at - float(low);
    for (size_t c = 0; c < 4; ++c)
        out[c] = rest > 0 ? rows[low][c] * (1 - rest) + rows[low + 1][c] * rest : rows[low][c];
    return out;
}

/// Calls body with a point of one to four dimensions of a vector and a fourth coordinate, which is the only one in 1D.
template <class Body>
auto in_dimensions(uint8_t dimensions, const Vec3f &p, float w, const Body &body) {
    switch (dimensions) {
    case 0:
        return body(Point<1>{w});
    case 1:
        return body(Point<2>{p.x, p.y});
    case 2:
        return body(Point<3>{p.x, p.y, p.z});
    default:
        return body(Point<4>{p.x, p.y, p.z, w});
    }
}

template <class P>
constexpr size_t kDimensions = std::tuple_size_v<std::remove_cvref_t<P>>;

} // namespace

/// A program at a place.
class Evaluation {
  public:
    Evaluation(const Program &program, const ShaderGlobals &globals) : program_(program), g_(globals) {}

    void run(Vec3f *outputs) {
        for (const Instruction &i : program_.instructions_)
            registers_[i.out] = step(i);
        for (size_t o = 0; o < program_.outputs_.size(); ++o)
            outputs[o] = registers_[program_.outputs_[o]];
    }

  private:
    const Vec3f &vector(const Instruction &i, size_t n) const {
        const uint16_t operand = i.in[n];
        return operand & GLIMMER_CONSTANT ? program_.constants_[operand & ~GLIMMER_CONSTANT] : registers_[operand];
    }
    float number(const Instruction &i, size_t n) const { return vector(i, n).x; }

    Vec3f step(const Instruction &i) const {
        const auto op = Op(i.op);
        return op <= Op::vector_transform ? arithmetic(op, i)
               : op <= Op::curve          ? color(op, i)
               : op <= Op::image_alpha    ? texture(op, i)
                                          : surface(op, i);
    }

    Vec3f arithmetic(Op op, const Instruction &i) const {
        switch (op) {
        case Op::math: {
            const float x = math(MathKind(i.mode[0]), number(i, 0), number(i, 1), number(i, 2));
            return gray(i.mode[1] ? unit(x) : x);
        }
        case Op::vector_math:
            return vector_math(VectorMathKind(i.mode[0]), vector(i, 0), vector(i, 1), vector(i, 2), number(i, 3));
        case Op::dot:
            return gray(dot(vector(i, 0), vector(i, 1)));
        case Op::distance:
            return gray(length(vector(i, 0) - vector(i, 1)));
        case Op::combine:
            return {number(i, 0), number(i, 1), number(i, 2)};
        case Op::separate:
            return gray(vector(i, 0)[i.mode[0]]);
        case Op::luminance:
            return gray(luminance(vector(i, 0)));
        case Op::average:
            return gray(average(vector(i, 0)));
        case Op::splat:
            return gray(number(i, 0));
        case Op::map_range:
            return gray(map_range(MapRangeKind(i.mode[0]), number(i, 0),
                                  {number(i, 1), number(i, 2), number(i, 3), number(i, 4), number(i, 5)}, i.mode[1]));
        case Op::vector_map_range: {
            const auto channel = [&](int c) {
                return map_range(MapRangeKind(i.mode[0]), vector(i, 0)[c],
                                 {vector(i, 1)[c], vector(i, 2)[c], vector(i, 3)[c], vector(i, 4)[c], vector(i, 5)[c]},
                                 i.mode[1]);
            };
            return {channel(0), channel(1), channel(2)};
        }
        case Op::clamp: {
            float low = number(i, 1), high = number(i, 2);
            if (i.mode[0] && low > high)
                std::swap(low, high);
            return gray(std::min(std::max(number(i, 0), low), high));
        }
        case Op::mix_number: {
            const float t = number(i, 0);
            return gray(number(i, 1) * (1 - t) + number(i, 2) * t);
        }
        case Op::mix_vector: {
            const Vec3f &t = vector(i, 0);
            return product(vector(i, 1), Vec3f(1, 1, 1) - t) + product(vector(i, 2), t);
        }
        case Op::mapping:
            return mapping(MappingKind(i.mode[0]), vector(i, 0), vector(i, 1), vector(i, 2), vector(i, 3));
        case Op::vector_rotate:
            return vector_rotate(RotateKind(i.mode[0]), i.mode[1], vector(i, 0), vector(i, 1), vector(i, 2),
                                 number(i, 3), vector(i, 4));
        default:
            return transformed(i);
        }
    }

    Vec3f color(Op op, const Instruction &i) const {
        switch (op) {
        case Op::blend: {
            const Vec3f out = blend(BlendKind(i.mode[0]), number(i, 0), vector(i, 1), vector(i, 2));
            return i.mode[1] ? unit(out) : out;
        }
        case Op::convert:
            return convert(ConvertKind(i.mode[0]), vector(i, 0));
        case Op::hue_saturation:
            return hue_saturation(number(i, 0), number(i, 1), number(i, 2), number(i, 3), vector(i, 4));
        case Op::bright_contrast:
            return bright_contrast(vector(i, 0), number(i, 1), number(i, 2));
        case Op::gamma:
            return gamma(vector(i, 0), number(i, 1));
        case Op::invert:
            return invert(number(i, 0), vector(i, 1));
        case Op::ramp: {
            const auto row = row_at(program_.tables_[i.resource], number(i, 0), i.mode[0], false);
            return {row[0], row[1], row[2]};
        }
        case Op::ramp_alpha:
            return gray(row_at(program_.tables_[i.resource], number(i, 0), i.mode[0], false)[3]);
        case Op::curves: {
            const ColorTable &table = program_.tables_[i.resource];
            const Vec3f &c = vector(i, 1);
            const Vec3f bent{row_at(table, c.x, false, i.mode[0])[0], row_at(table, c.y, false, i.mode[0])[1],
                             row_at(table, c.z, false, i.mode[0])[2]};
            return lerp(c, bent, number(i, 0));
        }
        default: { // curve
            const float t = number(i, 0), x = number(i, 1);
            return gray((1 - t) * x + t * row_at(program_.tables_[i.resource], x, false, i.mode[0])[0]);
        }
        }
    }

    Vec3f texture(Op op, const Instruction &i) const {
        switch (op) {
        case Op::noise:
        case Op::noise_color:
            return perlin_noise(op, i);
        case Op::musgrave: {
            NoiseParameters n;
            n.kind = NoiseKind(i.mode[1]);
            n.detail = number(i, 2);
            n.lacunarity = number(i, 4);
            n.offset = number(i, 5);
            n.gain = number(i, 6);
            return gray(in_dimensions(i.mode[0], vector(i, 0), number(i, 1), [&](const auto &p) {
                return musgrave<kDimensions<decltype(p)>>(p, number(i, 3), n);
            }));
        }
        case Op::voronoi:
        case Op::voronoi_color:
        case Op::voronoi_w:
            return cells(op, i);
        case Op::white_noise:
            return gray(in_dimensions(i.mode[0], vector(i, 0), number(i, 1),
                                      [](const auto &p) { return hash_point<kDimensions<decltype(p)>>(p); }));
        case Op::white_noise_color:
            return in_dimensions(i.mode[0], vector(i, 0), number(i, 1), [](const auto &p) { return hash_color(p); });
        case Op::wave:
            return gray(
                wave(vector(i, 0), {number(i, 1), number(i, 2), number(i, 3), number(i, 4), number(i, 5),
                                    WaveKind(i.mode[0]), WaveAxis(i.mode[1]), WaveProfile(i.mode[2]), i.mode[3] != 0}));
        case Op::checker:
            return gray(checker(vector(i, 0)));
        case Op::gradient:
            return gray(gradient(GradientKind(i.mode[0]), vector(i, 0)));
        case Op::magic:
            return magic(vector(i, 0), number(i, 1), number(i, 2), i.mode[0]);
        case Op::brick: {
            const Vec3f &offset = vector(i, 6), &squash = vector(i, 7); // (amount, frequency, -)
            const auto whole = [](float x) { return int(std::clamp(x, 0.0f, 1e6f)); };
            return brick(vector(i, 0), {number(i, 1), number(i, 2), number(i, 3), number(i, 4), number(i, 5), offset.x,
                                        squash.x, whole(offset.y), whole(squash.y)});
        }
        case Op::gabor:
            return gray(gabor(GaborOutput(i.mode[1]), i.mode[0] != 0, vector(i, 0), number(i, 1), number(i, 2),
                              number(i, 3), vector(i, 4)));
        case Op::grid:
            return grid(*program_.textures_[i.resource], vector(i, 0), vector(i, 1), i.mode[0] != 0);
        default: { // image, image_alpha
            const ImageMode mode{ProjectionKind(i.mode[0]), Interpolation(i.mode[1]), Extension(i.mode[2]),
                                 i.mode[3] != 0};
            const Vec3f normal = mode.projection == ProjectionKind::box ? object_normal(g_.normal) : Vec3f();
            const Texel t = image(*program_.textures_[i.resource], mode, vector(i, 0), normal, number(i, 1));
            return op == Op::image ? Vec3f{t.r, t.g, t.b} : gray(t.a);
        }
        }
    }

    Vec3f perlin_noise(Op op, const Instruction &i) const {
        NoiseParameters n;
        n.kind = NoiseKind(i.mode[1]);
        n.normalized = i.mode[2] != 0;
        n.before_4 = i.mode[3] != 0;
        n.detail = number(i, 2);
        n.roughness = number(i, 3);
        n.lacunarity = number(i, 4);
        n.offset = number(i, 5);
        n.gain = number(i, 6);
        n.distortion = number(i, 7);
        return in_dimensions(i.mode[0], vector(i, 0), number(i, 1), [&](const auto &p) {
            constexpr size_t kN = kDimensions<decltype(p)>;
            return op == Op::noise ? gray(noise<kN>(p, n)) : noise_color<kN>(p, n);
        });
    }

    Vec3f cells(Op op, const Instruction &i) const {
        VoronoiParameters v;
        v.feature = VoronoiFeature(i.mode[1]);
        v.metric = VoronoiMetric(i.mode[2]);
        v.normalized = i.mode[3] != 0;
        v.pcg = i.mode[4] != 0;
        v.scale = number(i, 2);
        v.detail = number(i, 3);
        v.roughness = number(i, 4);
        v.lacunarity = number(i, 5);
        v.smoothness = number(i, 6);
        v.exponent = number(i, 7);
        v.randomness = number(i, 8);
        return in_dimensions(i.mode[0], vector(i, 0) * v.scale, number(i, 1) * v.scale, [&](const auto &p) {
            constexpr size_t kN = kDimensions<decltype(p)>;
            if (v.feature == VoronoiFeature::distance_to_edge)
                return gray(voronoi_distance_to_edge<kN>(v, p));
            if (v.feature == VoronoiFeature::sphere_radius)
                return gray(voronoi_sphere_radius<kN>(v, p));
            const VoronoiResult r = voronoi<kN>(v, p);
            if (op == Op::voronoi)
                return gray(r.distance);
            if (op == Op::voronoi_w)
                return gray(r.w);
            return i.mode[5] ? r.position : r.color;
        });
    }

    Vec3f surface(Op op, const Instruction &i) const {
        switch (op) {
        case Op::geometry:
            return geometry(i);
        case Op::geometry_number:
            return gray(geometry_number(i.mode[0]));
        case Op::attribute: {
            const auto a = attribute(i);
            return {a[0], a[1], a[2]};
        }
        case Op::attribute_alpha:
            return gray(attribute(i)[3]);
        case Op::fresnel:
            return gray(fresnel(number(i, 0), vector(i, 1), g_.incoming, g_.backfacing));
        case Op::layer_weight:
            if (i.mode[0])
                return gray(facing(number(i, 0), vector(i, 1), g_.incoming));
            return gray(fresnel(1 / std::max(1 - number(i, 0), 1e-5f), vector(i, 1), g_.incoming, g_.backfacing));
        case Op::bump:
            return bump(
                {number(i, 0), number(i, 1), number(i, 2), number(i, 3), number(i, 4), vector(i, 5), number(i, 6)},
                g_.dpdx, g_.dpdy);
        case Op::normal_map:
            return normal_map(i);
        case Op::wireframe:
            return gray(is_on_edge(number(i, 0), i.mode[0] != 0) ? 1.0f : 0.0f);
        default: // tangent
            return safe_normalize(cross(g_.normal, safe_normalize(cross(world_normal(vector(i, 0)), g_.normal))));
        }
    }

    /// The footprint of a bump's shifted evaluation.
    Vec3f shift(uint8_t which, float width) const {
        return which == 0 ? Vec3f() : (which == 1 ? g_.dpdx : g_.dpdy) * width;
    }

    Vec3f to_object(const Vec3f &v) const { return g_.object ? times(g_.object->to_object, v) : v; }
    Vec3f object_normal(const Vec3f &n) const {
        return g_.object ? safe_normalize(times_transposed(g_.object->to_world, n)) : n;
    }
    Vec3f world_normal(const Vec3f &n) const {
        return g_.object ? safe_normalize(times_transposed(g_.object->to_object, n)) : n;
    }
    Vec3f to_camera(const Vec3f &p) const { return times(g_.camera->to_camera, p - g_.camera->position); }

    Vec3f geometry(const Instruction &i) const {
        enum {
            position,
            normal,
            true_normal,
            incoming,
            parametric,
            object_position,
            object_normal_,
            camera,
            window,
            reflection,
            object_location,
            object_color
        };
        const Vec3f d = shift(i.mode[1], number(i, 0));
        switch (i.mode[0]) {
        case position:
            return g_.position + d;
        case normal:
            return g_.normal;
        case true_normal:
            return g_.true_normal;
        case incoming:
            return g_.incoming;
        case parametric: {
            const Vec2f uv = barycentrics(i.mode[1], number(i, 0));
            return {1 - uv.x - uv.y, uv.x, 0};
        }
        case object_position:
            return g_.object_position + to_object(d);
        case object_normal_:
            return object_normal(g_.normal);
        case camera:
            return g_.camera ? to_camera(g_.object ? g_.position + d : g_.position + g_.camera->position) : g_.position;
        case window: {
            if (!g_.camera)
                return {};
            const Vec3f p = to_camera(g_.object ? g_.position + d : g_.position + g_.camera->position);
            if (g_.camera->panorama) {
                const Vec2f place = g_.camera->panorama->place(safe_normalize(g_.camera->in_panorama(p)));
                return {place.x, place.y, 0};
            }
            const float across = 2 * g_.camera->half_width * (g_.camera->orthographic ? 1 : p.z);
            if (across == 0)
                return {};
            return {0.5f + p.x / across - g_.camera->shift.x,
                    0.5f + (p.y / across - g_.camera->shift.y) / g_.camera->aspect, 0};
        }
        case reflection:
            return g_.object ? reflected(-g_.incoming, g_.normal) : g_.incoming;
        case object_location:
            return g_.object ? g_.object->location : Vec3f();
        default:
            return g_.object ? Vec3f{g_.object->color.r, g_.object->color.g, g_.object->color.b} : Vec3f();
        }
    }

    float geometry_number(uint8_t which) const {
        enum {
            backfacing,
            object_alpha,
            object_index,
            material_index,
            object_random,
            view_z,
            view_distance,
            camera_ray,
            shadow_ray,
            diffuse_ray,
            glossy_ray,
            singular_ray,
            reflection_ray,
            transmission_ray,
            ray_length,
            ray_depth,
            volume_scatter_ray
        };
        const auto flag = [&](uint32_t bit) { return g_.arrival.flags & bit ? 1.0f : 0.0f; };
        switch (which) {
        case backfacing:
            return g_.backfacing ? 1.0f : 0.0f;
        case object_alpha:
            return g_.object ? g_.object->alpha : 0.0f;
        case object_index:
            return g_.object ? g_.object->index : 0.0f;
        case material_index:
            return g_.material_index;
        case object_random:
            return g_.object ? g_.object->random : 0.0f;
        case view_z:
            return g_.camera ? std::abs(to_camera(g_.position).z) : 0.0f;
        case view_distance:
            return g_.camera ? length(to_camera(g_.position)) : 0.0f;
        case camera_ray:
            return flag(kCameraRay);
        case shadow_ray:
            return flag(kShadowRay);
        case diffuse_ray:
            return flag(kDiffuseRay);
        case glossy_ray:
            return flag(kGlossyRay);
        case singular_ray:
            return flag(kSingularRay);
        case reflection_ray:
            return flag(kReflectionRay);
        case transmission_ray:
            return flag(kTransmissionRay);
        case ray_length:
            return g_.arrival.length;
        case ray_depth:
            return g_.arrival.depth;
        case volume_scatter_ray:
            return flag(kVolumeScatterRay);
        default:
            return g_.sun_disc ? 1.0f : 0.0f;
        }
    }

    Vec2f barycentrics(uint8_t which, float width) const {
        if (which == 0)
            return {g_.u, g_.v};
        const Vec2f &d = which == 1 ? g_.dudx : g_.dudy;
        return {g_.u + width * d.x, g_.v + width * d.y};
    }

    /// Within half a width of an edge of the triangle; width: of the world, or of the picture's pixels.
    bool is_on_edge(float width, bool in_pixels) const {
        if (!g_.vertices || !g_.object)
            return false;
        if (in_pixels) {
            const auto across = [&](const Vec3f &d) { return length(d - g_.incoming * dot(d, g_.incoming)); };
            width *= 0.5f * (across(g_.dpdx) + across(g_.dpdy));
        }
        std::array<Vec3f, 3> corners;
        for (size_t k = 0; k < 3; ++k)
            corners[k] = g_.vertex_positions[(*g_.vertices)[k]];
        const Vec3f p = corners[0] * (1 - g_.u - g_.v) + corners[1] * g_.u + corners[2] * g_.v;
        for (size_t k = 0; k < 3; ++k) {
            const Vec3f along = times(g_.object->to_world, corners[(k + 1) % 3] - corners[k]);
            const Vec3f way = times(g_.object->to_world, p - corners[k]);
            if (length_squared(cross(along, way)) < length_squared(along) * (0.25f * width * width))
                return true;
        }
        return false;
    }

    const AttributeView *view_of(const Instruction &i) const {
        const uint32_t id = program_.attribute_ids_.empty() ? i.resource : program_.attribute_ids_[i.resource];
        if (id >= g_.attributes.size() || !g_.attributes[id].values)
            return nullptr;
        const AttributeView &view = g_.attributes[id]; // a point in a medium is on no triangle
        return g_.vertices || view.domain == AttributeDomain::instance ? &view : nullptr;
    }

    size_t row_of(const AttributeView &view, size_t corner) const {
        switch (view.domain) {
        case AttributeDomain::corner:
            return 3 * size_t(g_.triangle) + corner;
        case AttributeDomain::vertex:
            return (*g_.vertices)[corner];
        case AttributeDomain::face:
            return g_.triangle;
        case AttributeDomain::instance:
            break;
        }
        return g_.instance;
    }

    std::array<float, 4> attribute(const Instruction &i) const {
        std::array<float, 4> out{};
        const AttributeView *view = view_of(i);
        if (!view)
            return out;
        const Vec2f b = barycentrics(i.mode[0], number(i, 0));
        const float weights[] = {1 - b.x - b.y, b.x, b.y};
        for (size_t k = 0; k < 3; ++k) {
            const float *values = view->values + row_of(*view, k) * view->components;
            for (size_t c = 0; c < view->components; ++c)
                out[c] += weights[k] * values[c];
        }
        if (view->components == 1)
            out[1] = out[2] = out[0];
        if (view->components < 4)
            out[3] = 1;
        return out;
    }

    /// The vertices' normals between them, in the object's space, not of unit length; outward.
    Vec3f outward_normal() const {
        if (g_.vertex_normals && g_.vertices) {
            const auto &t = *g_.vertices;
            const Vec3f n = g_.vertex_normals[t[0]] * (1 - g_.u - g_.v) + g_.vertex_normals[t[1]] * g_.u +
                            g_.vertex_normals[t[2]] * g_.v;
            if (length_squared(n) > 0)
                return n;
        }
        return object_normal(g_.backfacing ? -g_.true_normal : g_.true_normal);
    }

    Vec3f normal_map(const Instruction &i) const {
        enum { tangent_space, object_space, world_space, blender_object, blender_world };
        const float strength = number(i, 0);
        Vec3f c = vector(i, 1) * 2.0f - gray(1);
        Vec3f n;
        bool along_a_line = true;
        if (i.mode[0] == tangent_space) {
            const AttributeView *view = view_of(i);
            if (!view)
                return g_.normal;
            const auto t = attribute_at(*view);
            const Vec3f tangent{t[0], t[1], t[2]}, normal = outward_normal();
            c = {c.x * strength, c.y * strength, 1 + (c.z - 1) * unit(strength)};
            n = world_normal(safe_normalize(tangent * c.x + cross(normal, tangent) * (t[3] * c.y) + normal * c.z));
            along_a_line = false;
        } else {
            if (i.mode[0] == blender_object || i.mode[0] == blender_world)
                c = {c.x, -c.y, -c.z};
            const bool own = i.mode[0] == object_space || i.mode[0] == blender_object;
            n = own ? world_normal(c) : safe_normalize(c);
        }
        if (g_.backfacing)
            n = -n;
        if (along_a_line && strength != 1)
            n = safe_normalize(g_.normal + (n - g_.normal) * std::max(strength, 0.0f));
        return length_squared(n) > 0 && std::isfinite(n.x + n.y + n.z) ? n : g_.normal;
    }

    std::array<float, 4> attribute_at(const AttributeView &view) const {
        std::array<float, 4> out{0, 0, 0, 1};
        const float weights[] = {1 - g_.u - g_.v, g_.u, g_.v};
        for (size_t c = 0; c < view.components; ++c) {
            out[c] = 0;
            for (size_t k = 0; k < 3; ++k) {
                out[c] += weights[k] * view.values[row_of(view, k) * view.components + c];
            }
        }
        return out;
    }

    /// Between the world's, the object's and the camera's space.
    Vec3f transformed(const Instruction &i) const {
        enum { as_vector, as_point, as_normal };
        enum { world, object, camera };
        Vec3f v = vector(i, 0);
        const uint8_t kind = i.mode[0], from = i.mode[1], to = i.mode[2];
        const bool point = kind == as_point;
        if (from == object && g_.object)
            v = kind == as_normal ? times_transposed(g_.object->to_object, v)
                                  : times(g_.object->to_world, v) + (point ? g_.object->location : Vec3f());
        else if (from == camera && g_.camera)
            v = times_transposed(g_.camera->to_camera, v) + (point ? g_.camera->position : Vec3f());
        if (to == object && g_.object)
            v = kind == as_normal ? times_transposed(g_.object->to_world, v)
                                  : times(g_.object->to_object, point ? v - g_.object->location : v);
        else if (to == camera && g_.camera)
            v = times(g_.camera->to_camera, point ? v - g_.camera->position : v);
        return kind == as_normal ? safe_normalize(v) : v;
    }

    const Program &program_;
    const ShaderGlobals &g_;
    std::array<Vec3f, Program::kMostRegisters> registers_;
};

void Program::evaluate(const ShaderGlobals &globals, Vec3f *outputs) const {
    Evaluation(*this, globals).run(outputs);
}

} // namespace glimmer
