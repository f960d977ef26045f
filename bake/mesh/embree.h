// SPDX-License-Identifier: Apache-2.0
// Wraps the Embree calls that differ between versions 3 and 4 (CMake: -DRELIEF_EMBREE=3|4), and configures Embree.
#pragma once

#include <glm/vec3.hpp>

#ifndef RELIEF_EMBREE
#error "RELIEF_EMBREE must be 3 or 4"
#elif RELIEF_EMBREE == 3
#include <embree3/rtcore.h>
#elif RELIEF_EMBREE == 4
#include <embree4/rtcore.h>
#else
#error "RELIEF_EMBREE must be 3 or 4"
#endif

namespace relief {

/// Configuration for rtcNewDevice(). By default, Embree uses the processor's widest instruction set. Fused multiply-add
/// changes which rays hit an edge; vector width changes which of two surfaces at equal depth comes first. The bytes of
/// a bake would then depend on the processor. This string selects SSE4.2 on every processor; if the processor does
/// not support it, Embree returns an error. The restriction costs about a tenth of a bake's time.
#if defined(__x86_64__)
inline constexpr const char* kEmbreeConfig = "isa=sse4.2";
#else
inline constexpr const char* kEmbreeConfig = nullptr;
#endif

#if RELIEF_EMBREE == 3
using EmbreeContext = RTCIntersectContext;
/// Flag of a scene whose rays have their own filter functions.
inline constexpr RTCSceneFlags kEmbreeRayFilters = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#else
using EmbreeContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kEmbreeRayFilters = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#endif

enum class RayOrder { kIncoherent, kCoherent };

/// The context of a ray or ray packet. Filter functions access it through of().
class RayQuery {
  public:
    /// Initializes a query.
    /// \param filter  runs for each surface on the ray, and requires a scene with kEmbreeRayFilters; null: the nearest
    /// surface is the hit.
    explicit RayQuery(RTCFilterFunctionN filter = nullptr, RayOrder order = RayOrder::kIncoherent) {
#if RELIEF_EMBREE == 3
        rtcInitIntersectContext(&context_);
        context_.filter = filter;
        context_.flags = order == RayOrder::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                      : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#else
        rtcInitRayQueryContext(&context_);
        filter_ = filter;
        order_ = order;
#endif
    }

    /// Returns the query of a filter function. Embree passes the filter a pointer to the first member, an
    /// EmbreeContext.
    static RayQuery* of(const RTCFilterFunctionNArguments* args) {
        return reinterpret_cast<RayQuery*>(args->context);
    }

#if RELIEF_EMBREE == 3
    /// Traces a ray. `ray.hit.geomID` stays RTC_INVALID_GEOMETRY_ID if there is no hit.
    void intersect(RTCScene scene, RTCRayHit& ray) {
        rtcIntersect1(scene, &context_, &ray);
    }
    /// Traces up to sixteen rays: the rays whose `valid` is −1.
    void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
        rtcIntersect16(valid, scene, &context_, &rays);
    }
    /// Traces a shadow ray. `ray.tfar` becomes −∞ on a hit.
    void occluded(RTCScene scene, RTCRay& ray) {
        rtcOccluded1(scene, &context_, &ray);
    }
#else
    void intersect(RTCScene scene, RTCRayHit& ray) {
        auto arguments = withContext(rtcInitIntersectArguments);
        rtcIntersect1(scene, &ray, &arguments);
    }
    void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
        auto arguments = withContext(rtcInitIntersectArguments);
        rtcIntersect16(valid, scene, &rays, &arguments);
    }
    void occluded(RTCScene scene, RTCRay& ray) {
        auto arguments = withContext(rtcInitOccludedArguments);
        rtcOccluded1(scene, &ray, &arguments);
    }
#endif

  private:
    EmbreeContext context_{};
#if RELIEF_EMBREE == 4
    template <class Arguments>
    Arguments withContext(void (*init)(Arguments*)) {
        Arguments arguments;
        init(&arguments);
        arguments.context = &context_;
        arguments.filter = filter_;
        // Without ARGUMENT_FILTER, Embree runs only the filters of geometries.
        const int flags =
            (order_ == RayOrder::kCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) |
            (filter_ != nullptr ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : RTC_RAY_QUERY_FLAG_NONE);
        arguments.flags = static_cast<RTCRayQueryFlags>(flags);
        return arguments;
    }

    RTCFilterFunctionN filter_ = nullptr;
    RayOrder order_ = RayOrder::kIncoherent;
#endif
};

/// Builds a ray in the space of EmbreeMesh::toLocal(); `end` is in lengths of `direction`.
[[nodiscard]] inline RTCRayHit rayHit(const glm::vec3& origin, const glm::vec3& direction, float end) {
    RTCRayHit query{};
    query.ray.org_x = origin.x;
    query.ray.org_y = origin.y;
    query.ray.org_z = origin.z;
    query.ray.dir_x = direction.x;
    query.ray.dir_y = direction.y;
    query.ray.dir_z = direction.z;
    query.ray.tfar = end;
    query.ray.mask = 0xffffffff;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return query;
}

}  // namespace relief
