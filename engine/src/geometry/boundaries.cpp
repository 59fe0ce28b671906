// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/boundaries.h"

#include "geometry/embree_geometry.h"
#include "math/rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace glimmer {

namespace {

/// A surface on the ray: a triangle of an instance, or, with instance kNone, a sphere.
struct Meeting {
    float t;
    uint32_t instance, primitive;
    bool enters; ///< of a sphere
};

struct Collector {
    RTCIntersectContext embree; // first: Embree hands back a pointer to it
    std::vector<Meeting> *meetings;
};

/// Notes every triangle, and lets the ray go on.
void collect_triangle(const RTCFilterFunctionNArguments *args) {
    if (!args->valid[0])
        return;
    const auto *ray = reinterpret_cast<const RTCRay *>(args->ray);
    const auto *hit = reinterpret_cast<const RTCHit *>(args->hit);
    reinterpret_cast<Collector *>(args->context)->meetings->push_back({ray->tfar, hit->instID[0], hit->primID, false});
    args->valid[0] = 0;
}

void collect_sphere(const RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0])
        return;
    const RTCRay &ray = reinterpret_cast<const RTCRayHit *>(args->rayhit)->ray;
    const Sphere &sphere = (*static_cast<const std::vector<Sphere> *>(args->geometryUserPtr))[args->primID];
    const auto roots = intersect_sphere(sphere, {ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z});
    if (!roots)
        return;
    std::vector<Meeting> &meetings = *reinterpret_cast<Collector *>(args->context)->meetings;
    if (roots->near > double(kNearestHit))
        meetings.push_back({float(roots->near), kNone, args->primID, true});
    if (roots->far > double(kNearestHit))
        meetings.push_back({float(roots->far), kNone, args->primID, false});
}

void occlude_nothing(const RTCOccludedFunctionNArguments *) {}

Bvh build_mesh(const EmbreeDevice &device, const Mesh &mesh) {
    const Bvh built = new_bvh(device);
    RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.vertices.data(), 0,
                               sizeof(Vec3f), mesh.vertices.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(mesh.triangles[0]), mesh.triangles.size());
    rtcSetGeometryIntersectFilterFunction(geometry, collect_triangle);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(built.get(), geometry, 0);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(built.get());
    device.check(("mesh \"" + mesh.name + "\"").c_str());
    return built;
}

/// Whether a ray passes the triangle from its outside to its inside.
bool enters_through(const Instance &instance, uint32_t triangle, const Vec3f &direction) {
    const auto &corners = instance.mesh->triangles[triangle];
    const Vec3d a(instance.mesh->vertices[corners[0]]), b(instance.mesh->vertices[corners[1]]),
        c(instance.mesh->vertices[corners[2]]);
    const Vec3d local = cross(b - a, c - a);
    const auto &rows = instance.normal_matrix;
    const Vec3d normal(dot(Vec3d(rows[0]), local), dot(Vec3d(rows[1]), local), dot(Vec3d(rows[2]), local));
    return dot(normal, Vec3d(direction)) < 0;
}

constexpr size_t kMostConvexTriangles = 4096; // whose planes are tested against all corners
constexpr double kConvexRounding = 1e-5;      // of the mesh's radius: how far a corner may stand out

bool is_convex(const Mesh &mesh) {
    if (mesh.triangles.size() < 4 || mesh.triangles.size() > kMostConvexTriangles)
        return false;
    for (const auto &t : mesh.triangles) {
        const Vec3d a(mesh.vertices[t[0]]), b(mesh.vertices[t[1]]), c(mesh.vertices[t[2]]);
        const Vec3d normal = cross(b - a, c - a);
        const double most = kConvexRounding * double(mesh.radius) * length(normal);
        for (const auto &other : mesh.triangles)
            for (uint32_t corner : other)
                if (dot(normal, Vec3d(mesh.vertices[corner]) - a) > most)
                    return false;
    }
    return mesh.is_closed();
}

constexpr size_t kMostPlanes = 24; // beyond which a BVH is faster

/// Of a convex mesh: the planes of its triangles, each once; none where they are many.
ConvexBody polytope_of(const Instance &instance) {
    ConvexBody body;
    for (const auto &t : instance.mesh->triangles) {
        const Vec3d a(instance.mesh->vertices[t[0]]), b(instance.mesh->vertices[t[1]]),
            c(instance.mesh->vertices[t[2]]);
        const Vec3d local = cross(b - a, c - a);
        if (!(length(local) > 0))
            continue;
        const auto world = [&](const std::array<Vec3f, 3> &rows, const Vec3d &v) {
            return Vec3d(dot(Vec3d(rows[0]), v), dot(Vec3d(rows[1]), v), dot(Vec3d(rows[2]), v));
        };
        const Vec3d normal = normalize(world(instance.normal_matrix, normalize(local)));
        const double offset = dot(normal, world(instance.linear, a) + Vec3d(instance.translation));
        const double scale = std::abs(offset) + length(world(instance.linear, a));
        const bool known = std::ranges::any_of(body.planes, [&](const ConvexBody::Plane &p) {
            return length(Vec3d(p.normal) - normal) < 1e-6 && std::abs(double(p.offset) - offset) <= 1e-6 * scale;
        });
        if (!known)
            body.planes.push_back({Vec3f(normal), float(offset)});
        if (body.planes.size() > kMostPlanes)
            return {};
    }
    return body;
}

} // namespace

Boundaries::Boundaries(std::vector<Instance> instances, std::vector<InstanceMotion> motions,
                       std::vector<Sphere> spheres, uint32_t threads)
    : instances_(std::move(instances)), motions_(std::move(motions)), spheres_(std::move(spheres)),
      reach_(kMostCoordinate), device_(embree_device(threads)) {
    for (const InstanceMotion &motion : motions_)
        for (const Instance &step : motion)
            reach_ = std::min(reach_, 0.5f * step.reach()); // between two steps the inverse is larger
    const size_t before = device_->bytes();
    std::map<const Mesh *, Bvh> built;
    bvh_ = new_bvh(*device_);
    for (size_t i = 0; i < instances_.size(); ++i) {
        const Instance &instance = instances_[i];
        reach_ = std::min(reach_, instance.reach());
        Bvh &mesh = built[instance.mesh];
        if (!mesh)
            mesh = build_mesh(*device_, *instance.mesh);
        attach_instance(*device_, bvh_.get(), mesh.get(), instance, motions_, unsigned(i));
    }
    for (auto &[mesh, bvh] : built)
        meshes_.push_back(std::move(bvh));
    if (!spheres_.empty())
        attach_spheres(*device_, bvh_.get(), spheres_, unsigned(instances_.size()), collect_sphere, occlude_nothing);
    rtcCommitScene(bvh_.get());
    device_->check("the boundaries of media");
    bvh_bytes_ = std::max(device_->bytes(), before) - before;
    convex_ = size() == 1 && !moves() && (instances_.empty() || is_convex(*instances_[0].mesh));
    if (convex_ && !instances_.empty())
        polytope_ = polytope_of(instances_[0]);
}

Sphere Boundaries::bounds() const {
    Vec3d low(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = -low;
    const auto add = [&](const Vec3d &p, double r) {
        low = {std::min(low.x, p.x - r), std::min(low.y, p.y - r), std::min(low.z, p.z - r)};
        high = {std::max(high.x, p.x + r), std::max(high.y, p.y + r), std::max(high.z, p.z + r)};
    };
    const auto add_instance = [&](const Instance &instance) {
        for (const auto &t : instance.mesh->triangles)
            for (uint32_t corner : t)
                add(Vec3d(instance.to_world(instance.mesh->vertices[corner])), 0);
    };
    for (const Instance &instance : instances_)
        add_instance(instance);
    for (const InstanceMotion &motion : motions_)
        for (const Instance &step : motion)
            add_instance(step);
    for (const Sphere &s : spheres_)
        add(s.center, s.radius);
    return {(low + high) * 0.5, length(high - low) * 0.5};
}

RayInterval ConvexBody::clip(const Ray &ray) const {
    RayInterval part{-kInfinity, kInfinity};
    for (const Plane &p : planes) {
        const float along = dot(p.normal, ray.direction), left = p.offset - dot(p.normal, ray.origin);
        if (along > 0)
            part.end = std::min(part.end, left / along);
        else if (along < 0)
            part.begin = std::max(part.begin, left / along);
        else if (left < 0)
            return {0, 0};
    }
    return part;
}

size_t Boundaries::bytes() const {
    return instances_.size() * sizeof(Instance) + spheres_.size() * sizeof(Sphere) + bvh_bytes_;
}

std::optional<Instance> Boundaries::instance(uint32_t body, ShutterTime time) const {
    if (body >= instances_.size())
        return std::nullopt;
    const Instance &opening = instances_[body];
    return opening.motion == kNone ? opening : interpolate(motions_[opening.motion], time);
}

BodyFrame Boundaries::frame(uint32_t body, ShutterTime time) const {
    BodyFrame out;
    const std::optional<Instance> placed = instance(body, time);
    if (!placed) {
        const Sphere &own = sphere(body);
        const auto inverse = float(1 / own.radius);
        out.to_local = {Vec3f{inverse, 0, 0}, {0, inverse, 0}, {0, 0, inverse}};
        out.translation = Vec3f(own.center);
        return out;
    }
    Linear linear;
    for (size_t r = 0; r < 3; ++r)
        linear.rows[r] = Vec3d(placed->linear[r]);
    const Linear inverse = linear.cofactor().transposed();
    const double determinant = linear.determinant();
    for (size_t r = 0; r < 3; ++r)
        out.to_local[r] = Vec3f(inverse.rows[r] / determinant);
    out.translation = placed->translation;
    return out;
}

void Boundaries::local_bounds(uint32_t body, Vec3f &low, Vec3f &high) const {
    low = {-1, -1, -1}, high = {1, 1, 1};
    if (body >= instances_.size())
        return;
    const Mesh &mesh = *instances_[body].mesh;
    low = high = mesh.vertices[0];
    for (const auto &triangle : mesh.triangles)
        for (const uint32_t corner : triangle) {
            const Vec3f &v = mesh.vertices[corner];
            low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
            high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
        }
}

void Boundaries::cross(const Ray &ray, std::vector<Crossing> &crossings) const {
    crossings.clear();
    Ray whole = ray;
    whole.t_max = kInfinity;
    if (!starts_within(whole, reach_))
        return;
    if (!polytope_.planes.empty()) {
        const RayInterval part = polytope_.clip(ray);
        if (!(part.begin < part.end) || !(part.end > 0))
            return;
        if (part.begin > 0)
            crossings.push_back({part.begin, 0, true});
        crossings.push_back({part.end, 0, false});
        return;
    }
    thread_local std::vector<Meeting> meetings;
    meetings.clear();
    RTCRayHit query{};
    query.ray = embree_ray(whole);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Collector collector{};
    rtcInitIntersectContext(&collector.embree);
    collector.meetings = &meetings;
    rtcIntersect1(bvh_.get(), &collector.embree, &query);
    for (const Meeting &m : meetings) {
        if (m.instance == kNone) {
            crossings.push_back({m.t, uint32_t(instances_.size()) + m.primitive, m.enters});
            continue;
        }
        const Instance &opening = instances_[m.instance];
        const bool enters = opening.motion == kNone ? enters_through(opening, m.primitive, ray.direction)
                                                    : enters_through(interpolate(motions_[opening.motion], ray.time),
                                                                     m.primitive, ray.direction);
        crossings.push_back({m.t, m.instance, enters});
    }
    std::ranges::sort(crossings, [](const Crossing &a, const Crossing &b) {
        return a.t != b.t ? a.t < b.t : a.body != b.body ? a.body < b.body : a.enters < b.enters;
    });
    // An edge, or a corner, that the ray goes through is met with all of its triangles, but passed once.
    const auto same = [](const Crossing &a, const Crossing &b) {
        return a.body == b.body && a.enters == b.enters && b.t - a.t <= kHitRounding * b.t;
    };
    crossings.erase(std::unique(crossings.begin(), crossings.end(), same), crossings.end());
}

} // namespace glimmer
