// Embree 3 or 4, as RELIEF_EMBREE says (CMake: -DRELIEF_EMBREE=3|4): the few calls in which they differ. Everything else
// that Relief takes of Embree is the same in both.
#pragma once

#ifndef RELIEF_EMBREE
#error "RELIEF_EMBREE says which Embree it is: 3 or 4"
#elif RELIEF_EMBREE == 3
#include <embree3/rtcore.h>
#elif RELIEF_EMBREE == 4
#include <embree4/rtcore.h>
#else
#error "RELIEF_EMBREE is 3 or 4"
#endif

namespace relief {

#if RELIEF_EMBREE == 3
using EmbreeContext = RTCIntersectContext;
/// A scene whose rays bring filter functions of their own.
inline constexpr RTCSceneFlags kEmbreeRayFilters = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#else
using EmbreeContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kEmbreeRayFilters = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#endif

enum class RayOrder { kIncoherent, kCoherent };

/// What goes with a ray, or with a packet of them. A filter function finds it by of().
class RayQuery {
  public:
    /// `filter` is asked about each surface that a ray meets; null: the nearest one counts. It needs a scene with
    /// kEmbreeRayFilters.
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

    /// The query that a filter function works for. EmbreeContext is the first member: Embree hands back the pointer that
    /// it was given.
    static RayQuery* of(const RTCFilterFunctionNArguments* args) {
        return reinterpret_cast<RayQuery*>(args->context);
    }

    /// Traces the ray; `ray.hit.geomID` stays RTC_INVALID_GEOMETRY_ID where it meets nothing.
    void intersect(RTCScene scene, RTCRayHit& ray) {
#if RELIEF_EMBREE == 3
        rtcIntersect1(scene, &context_, &ray);
#else
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        fill(arguments);
        rtcIntersect1(scene, &ray, &arguments);
#endif
    }

    /// The same of sixteen rays, of those whose `valid` is −1.
    void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
#if RELIEF_EMBREE == 3
        rtcIntersect16(valid, scene, &context_, &rays);
#else
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        fill(arguments);
        rtcIntersect16(valid, scene, &rays, &arguments);
#endif
    }

    /// `ray.tfar` becomes −∞ where the ray meets something.
    void occluded(RTCScene scene, RTCRay& ray) {
#if RELIEF_EMBREE == 3
        rtcOccluded1(scene, &context_, &ray);
#else
        RTCOccludedArguments arguments;
        rtcInitOccludedArguments(&arguments);
        fill(arguments);
        rtcOccluded1(scene, &ray, &arguments);
#endif
    }

  private:
    EmbreeContext context_{};
#if RELIEF_EMBREE == 4
    template <class Arguments>
    void fill(Arguments& arguments) {
        arguments.context = &context_;
        arguments.filter = filter_;
        // Without this flag Embree asks only the filters of geometries.
        const int flags =
            (order_ == RayOrder::kCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) |
            (filter_ != nullptr ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : RTC_RAY_QUERY_FLAG_NONE);
        arguments.flags = static_cast<RTCRayQueryFlags>(flags);
    }

    RTCFilterFunctionN filter_ = nullptr;
    RayOrder order_ = RayOrder::kIncoherent;
#endif
};

}  // namespace relief
