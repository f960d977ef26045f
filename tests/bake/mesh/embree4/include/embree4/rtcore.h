// SPDX-License-Identifier: Apache-2.0
// A substitute for <embree4/rtcore.h> on systems without Embree 4. It uses Embree 3 to implement the names and
// signatures of the Embree 4 manual that differ from version 3, so that -DRELIEF_EMBREE=4 compiles and bakes
// (tests/cli/embree4.sh, scripts/nightly.sh embree4).
#pragma once

// The context of Embree 4 has no filter and no flags. The end of this file makes their use an error.
#define RTCIntersectContext RTCRayQueryContext
#include <embree3/rtcore.h>
#undef RTCIntersectContext

enum RTCRayQueryFlags {
    RTC_RAY_QUERY_FLAG_NONE = 0,
    RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER = 1 << 1,
    RTC_RAY_QUERY_FLAG_INCOHERENT = 0 << 16,
    RTC_RAY_QUERY_FLAG_COHERENT = 1 << 16
};

enum RTCFeatureFlags : unsigned { RTC_FEATURE_FLAG_NONE = 0, RTC_FEATURE_FLAG_ALL = 0xffffffffU };

inline constexpr RTCSceneFlags RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS =
    RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

struct RTCIntersectArguments {
    RTCRayQueryFlags flags;
    RTCFeatureFlags feature_mask;
    RTCRayQueryContext* context;
    RTCFilterFunctionN filter;
    RTCIntersectFunctionN intersect;
};

struct RTCOccludedArguments {
    RTCRayQueryFlags flags;
    RTCFeatureFlags feature_mask;
    RTCRayQueryContext* context;
    RTCFilterFunctionN filter;
    RTCOccludedFunctionN occluded;
};

RTC_FORCEINLINE void rtcInitRayQueryContext(RTCRayQueryContext* context) {
    rtcInitIntersectContext(context);
}

RTC_FORCEINLINE void rtcInitIntersectArguments(RTCIntersectArguments* arguments) {
    *arguments = {RTC_RAY_QUERY_FLAG_INCOHERENT, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr};
}

RTC_FORCEINLINE void rtcInitOccludedArguments(RTCOccludedArguments* arguments) {
    *arguments = {RTC_RAY_QUERY_FLAG_INCOHERENT, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr};
}

/// As in Embree 4, the filter of the arguments runs only if the flags enable it, and the context has no filter.
template <class Arguments>
RTCRayQueryContext* embree3Context(const Arguments& arguments) {
    const bool enabled = (arguments.flags & RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER) != 0;
    arguments.context->filter = enabled ? arguments.filter : nullptr;
    arguments.context->flags = (arguments.flags & RTC_RAY_QUERY_FLAG_COHERENT) != 0
                                   ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                   : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return arguments.context;
}

inline void rtcIntersect1(RTCScene scene, RTCRayHit* ray, RTCIntersectArguments* arguments) {
    rtcIntersect1(scene, embree3Context(*arguments), ray);
}

inline void rtcIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rays,
                           RTCIntersectArguments* arguments) {
    rtcIntersect16(valid, scene, embree3Context(*arguments), rays);
}

inline void rtcOccluded1(RTCScene scene, RTCRay* ray, RTCOccludedArguments* arguments) {
    rtcOccluded1(scene, embree3Context(*arguments), ray);
}

// Names removed in Embree 4.
#pragma GCC poison RTCIntersectContext rtcInitIntersectContext RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
#pragma GCC poison RTC_INTERSECT_CONTEXT_FLAG_COHERENT RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
