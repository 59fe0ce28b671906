// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/accel.h"

#include "geometry/embree_geometry.h"
#include "math/affine.h"

#include <cmath>
#include <limits>
#include <map>

namespace glimmer {

namespace {

constexpr double kLeastVolume = 0x1p-20; // of the rows' lengths' product; below, Embree's float32 inverse is noise

struct Context {
    RTCIntersectContext embree; // first: Embree hands back a pointer to it
    uint32_t ignored_sphere;
    RayKind kind;
    const RayMask *visible; // of the spheres; null: all are
};

bool is_hidden(const Context &context, uint32_t sphere) {
    return context.visible && !meets(context.kind, context.visible[sphere]);
}

float round_down(double x) {
    return std::nextafter(float(x), -kInfinity);
}
float round_up(double x) {
    return std::nextafter(float(x), kInfinity);
}

void sphere_bounds(const RTCBoundsFunctionArguments *args) {
    const Sphere &s = (*static_cast<const std::vector<Sphere> *>(args->geometryUserPtr))[args->primID];
    RTCBounds &b = *args->bounds_o;
    b.lower_x = round_down(s.center.x - s.radius);
    b.lower_y = round_down(s.center.y - s.radius);
    b.lower_z = round_down(s.center.z - s.radius);
    b.upper_x = round_up(s.center.x + s.radius);
    b.upper_y = round_up(s.center.y + s.radius);
    b.upper_z = round_up(s.center.z + s.radius);
}

std::optional<float> first_root(const Sphere &sphere, const RTCRay &ray) {
    return first_root(sphere, {ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, double(ray.tfar));
}

void sphere_intersect(const RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0])
        return;
    if (is_hidden(*reinterpret_cast<const Context *>(args->context), args->primID))
        return;
    auto *hit = reinterpret_cast<RTCRayHit *>(args->rayhit);
    const Sphere &s = (*static_cast<const std::vector<Sphere> *>(args->geometryUserPtr))[args->primID];
    if (const auto t = first_root(s, hit->ray)) {
        hit->ray.tfar = *t;
        hit->hit.primID = args->primID;
        hit->hit.geomID = args->geomID;
        hit->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
}

void sphere_occluded(const RTCOccludedFunctionNArguments *args) {
    if (!args->valid[0])
        return;
    const Context &context = *reinterpret_cast<const Context *>(args->context);
    if (context.ignored_sphere == args->primID || is_hidden(context, args->primID))
        return;
    auto *ray = reinterpret_cast<RTCRay *>(args->ray);
    const Sphere &s = (*static_cast<const std::vector<Sphere> *>(args->geometryUserPtr))[args->primID];
    if (first_root(s, *ray))
        ray->tfar = -kInfinity;
}

void set_transform(RTCGeometry geometry, unsigned step, const Instance &instance) {
    float rows[12];
    for (size_t r = 0; r < 3; ++r) {
        rows[4 * r] = instance.linear[r].x;
        rows[4 * r + 1] = instance.linear[r].y;
        rows[4 * r + 2] = instance.linear[r].z;
        rows[4 * r + 3] = instance.translation[int(r)];
    }
    rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
}

} // namespace

void attach_instance(const EmbreeDevice &device, RTCScene scene, RTCScene mesh, const Instance &instance,
                     const std::vector<InstanceMotion> &motions, unsigned id) {
    RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh);
    if (instance.motion == kNone) {
        set_transform(geometry, 0, instance);
    } else {
        const InstanceMotion &motion = motions[instance.motion];
        rtcSetGeometryTimeStepCount(geometry, unsigned(motion.size()));
        for (size_t k = 0; k < motion.size(); ++k)
            set_transform(geometry, unsigned(k), motion[k]);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

void attach_spheres(const EmbreeDevice &device, RTCScene scene, const std::vector<Sphere> &spheres, unsigned id,
                    RTCIntersectFunctionN intersect, RTCOccludedFunctionN occluded) {
    RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(spheres.size()));
    rtcSetGeometryUserData(geometry, const_cast<std::vector<Sphere> *>(&spheres)); // which is only read
    rtcSetGeometryBoundsFunction(geometry, sphere_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

float Instance::reach() const {
    Linear l;
    for (size_t r = 0; r < 3; ++r)
        l.rows[r] = Vec3d(linear[r]);
    const double determinant = std::abs(l.determinant());
    const Linear cofactor = l.cofactor();
    double inverse = 0, largest = 0; // the largest sums of a row, of the inverse and of what it is made from
    for (int c = 0; c < 3; ++c) {
        const Vec3d column = cofactor.column(c);
        const double sum = std::abs(column.x) + std::abs(column.y) + std::abs(column.z);
        largest = std::max(largest, sum);
        inverse = std::max(inverse, sum / determinant);
    }
    constexpr double most = double(std::numeric_limits<float>::max()),
                     least = double(std::numeric_limits<float>::min());
    const bool invertible = determinant > kLeastVolume * length(l.rows[0]) * length(l.rows[1]) * length(l.rows[2]) &&
                            determinant >= least && determinant <= most && largest <= most;
    const double local = 0.25 * double(kMostCoordinate) / inverse - double(max_abs(translation));
    if (!invertible || !(local > 0) || !(inverse <= 1e12)) // 1e12 alone leaves rays little of the world
        return 0;
    return float(std::min(local, 0.5 * double(kMostCoordinate)));
}

bool Instance::place(const Linear &linear_map, const Vec3d &center) {
    for (size_t r = 0; r < 3; ++r)
        linear[r] = Vec3f(linear_map.rows[r]);
    translation = Vec3f(center);
    // Normalised, so that neither tiny nor huge scales under- or overflow in float32.
    Linear cofactor = linear_map.cofactor();
    const double scale = std::max({max_abs(cofactor.rows[0]), max_abs(cofactor.rows[1]), max_abs(cofactor.rows[2])});
    if (!(std::abs(linear_map.determinant()) > 0) || !std::isfinite(scale) || reach() == 0)
        return false;
    for (Vec3d &row : cofactor.rows)
        row = row / scale;
    if (linear_map.determinant() < 0) // a mirrored mesh keeps its outside
        for (Vec3d &row : cofactor.rows)
            row = -row;
    for (size_t r = 0; r < 3; ++r)
        normal_matrix[r] = Vec3f(cofactor.rows[r]);
    return true;
}

Instance interpolate(const InstanceMotion &motion, ShutterTime time) {
    const float at = time.value * float(motion.size() - 1);
    const size_t first = std::min(size_t(at), motion.size() - 2);
    const double f = double(at - float(first)), g = 1 - f;
    const Instance &a = motion[first], &b = motion[first + 1];
    Linear linear;
    for (size_t r = 0; r < 3; ++r)
        linear.rows[r] = Vec3d(a.linear[r]) * g + Vec3d(b.linear[r]) * f;
    Instance between = a;
    between.place(linear, Vec3d(a.translation) * g + Vec3d(b.translation) * f);
    return between;
}

bool is_solid(const InstanceMotion &motion) {
    constexpr size_t kLooks = 16; // between two steps
    const auto volume = [](const Instance &i) {
        return Linear{{Vec3d(i.linear[0]), Vec3d(i.linear[1]), Vec3d(i.linear[2])}}.determinant();
    };
    const size_t looks = kLooks * (motion.size() - 1);
    for (size_t k = 0; k <= looks; ++k) {
        const Instance at = interpolate(motion, ShutterTime(float(k) / float(looks)));
        if (at.reach() == 0 || (volume(at) < 0) != (volume(motion[0]) < 0))
            return false;
    }
    return true;
}

Accel::Accel(std::vector<Instance> instances, std::vector<InstanceMotion> motions, std::vector<Sphere> spheres,
             std::vector<RayMask> visible, uint32_t threads)
    : instances_(std::move(instances)), motions_(std::move(motions)), spheres_(std::move(spheres)),
      visible_(std::move(visible)), reach_(kMostCoordinate), device_(embree_device(threads)) {
    for (const Instance &instance : instances_) {
        reach_ = std::min(reach_, instance.reach());
        hides_ |= instance.visible != kEveryRay;
    }
    for (const RayMask mask : visible_)
        hides_ |= mask != kEveryRay;
    for (const InstanceMotion &motion : motions_)
        for (const Instance &step : motion)
            reach_ = std::min(reach_, 0.5f * step.reach()); // between two steps the inverse is larger
    std::vector<Bvh> meshes;                                // built before the memory is counted
    for (const Instance &instance : instances_)
        meshes.push_back(instance.mesh->bvh(device_));
    const size_t before = device_->bytes();
    // Kinds of rays that see the same share a BVH; where nothing is hidden, all of them.
    std::map<std::vector<bool>, RTCScene> known;
    for (size_t k = 0; k < kRayKinds; ++k) {
        const auto kind = RayKind(k);
        std::vector<bool> seen;
        for (size_t i = 0; hides_ && i < instances_.size(); ++i)
            seen.push_back(meets(kind, instances_[i].visible));
        RTCScene &scene = known[seen];
        if (!scene) {
            bvhs_.push_back(build(meshes, kind));
            scene = bvhs_.back().get();
        }
        scenes_[k] = scene;
    }
    bvh_bytes_ = std::max(device_->bytes(), before) - before;
    for (const Bvh &mesh : meshes)
        mesh_bvhs_.push_back(mesh.get());
}

/// Over what rays of a kind meet; of spheres over all, which are asked one by one.
Bvh Accel::build(const std::vector<Bvh> &meshes, RayKind kind) {
    Bvh bvh = new_bvh(*device_);
    for (size_t i = 0; i < instances_.size(); ++i)
        if (meets(kind, instances_[i].visible))
            attach_instance(*device_, bvh.get(), meshes[i].get(), instances_[i], motions_, unsigned(i));
    if (!spheres_.empty())
        attach_spheres(*device_, bvh.get(), spheres_, unsigned(instances_.size()), sphere_intersect, sphere_occluded);
    rtcCommitScene(bvh.get());
    device_->check("the scene");
    return bvh;
}

size_t Accel::bytes() const {
    size_t steps = instances_.size();
    for (const InstanceMotion &motion : motions_)
        steps += motion.size();
    return steps * sizeof(Instance) + spheres_.size() * sizeof(Sphere) + visible_.size() +
           mesh_bvhs_.size() * sizeof(RTCScene) + bvh_bytes_;
}

std::optional<Hit> Accel::intersect(const Ray &ray, RayKind kind) const {
    if (!can_trace(ray))
        return std::nullopt;
    if (without_bvh())
        return nearest_sphere(ray);
    RTCRayHit query{};
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Context context{};
    rtcInitIntersectContext(&context.embree);
    context.ignored_sphere = kNone;
    context.kind = kind;
    context.visible = visible_.empty() ? nullptr : visible_.data();
    rtcIntersect1(scene(kind), &context.embree, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return std::nullopt;
    Hit hit;
    hit.t = query.ray.tfar;
    hit.instance = query.hit.instID[0];
    hit.primitive = query.hit.primID;
    hit.u = query.hit.u;
    hit.v = query.hit.v;
    return hit;
}

bool Accel::occluded(const Ray &ray, RayKind kind, uint32_t ignored_sphere) const {
    if (!can_trace(ray))
        return false;
    if (without_bvh())
        return behind_sphere(ray, ignored_sphere);
    RTCRay query = embree_ray(ray);
    Context context{};
    rtcInitIntersectContext(&context.embree);
    context.ignored_sphere = ignored_sphere;
    context.kind = kind;
    context.visible = visible_.empty() ? nullptr : visible_.data();
    rtcOccluded1(scene(kind), &context.embree, &query);
    return query.tfar < 0;
}

} // namespace glimmer
