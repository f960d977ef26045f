// How Embree is started, the same way wherever it is used.
#pragma once

namespace relief {

/// For rtcNewDevice(). Embree brings code for several instruction sets and takes the widest that the
/// processor has; those with fused multiply-add decide otherwise whether a ray meets an edge, and those of
/// other widths which of two surfaces at one depth it meets first: another processor would bake other bytes.
/// So it is one set for all, which every processor since 2008 has; another one gets Embree's error. It costs
/// about a tenth of a planned bake.
#if defined(__x86_64__)
inline constexpr const char* kEmbreeConfig = "isa=sse4.2";
#else
inline constexpr const char* kEmbreeConfig = nullptr;
#endif

}  // namespace relief
