// SPDX-License-Identifier: Apache-2.0
// Stands for <embree4/rtcore.h> where there is no Embree 4: the names and signatures in which Embree 4 differs from 3, as
// its manual gives them, done by Embree 3. With it -DRELIEF_EMBREE=4 compiles and bakes
// (tests/cli/embree4.sh, scripts/nightly.sh embree4).
#pragma once

// Embree 4's context has no filter and no flags; code that takes them from it is told so at the end of this file.
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

/// As Embree 4: a filter among the arguments is asked only by those that say so, and is never the context's.
template <class Arguments>
RTCRayQueryContext* embree3Context(const Arguments& arguments) {
    const bool asked = (arguments.flags & RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER) != 0;
    arguments.context->filter = asked ? arguments.filter : nullptr;
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

// What Embree 4 no longer has.
#pragma GCC poison RTCIntersectContext rtcInitIntersectContext RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
#pragma GCC poison RTC_INTERSECT_CONTEXT_FLAG_COHERENT RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
