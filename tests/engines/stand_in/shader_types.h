// SPDX-License-Identifier: Apache-2.0
// C++ types and functions that stand in for those of GLSL, HLSL and MSL, as far as the texts of shaders/engines use
// them. A text compiles as C++ between shader_words_begin.h and shader_words_end.h, inside relief::stand_in. That
// executes its arithmetic on the CPU; it does not prove that a shader compiler accepts the text.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <vector>

namespace relief::stand_in {

using uint = std::uint32_t;

/// A float whose literals are floats without a suffix.
struct Real {
    float value;

    Real() = default;
    template <class T>
    requires std::floating_point<T> || std::integral<T>
    constexpr Real(T number) : value(static_cast<float>(number)) {}  // NOLINT(google-explicit-constructor)
    explicit operator int() const { return static_cast<int>(value); }
    explicit operator uint() const { return static_cast<uint>(value); }

    friend Real operator-(Real a) { return -a.value; }
    friend Real operator+(Real a, Real b) { return a.value + b.value; }
    friend Real operator-(Real a, Real b) { return a.value - b.value; }
    friend Real operator*(Real a, Real b) { return a.value * b.value; }
    friend bool operator<(Real a, Real b) { return a.value < b.value; }
    friend bool operator>(Real a, Real b) { return a.value > b.value; }
    friend bool operator>=(Real a, Real b) { return a.value >= b.value; }
    friend bool operator==(Real a, Real b) { return a.value == b.value; }
};

struct Real2 {
    Real x, y;
    Real2() = default;
    Real2(Real a, Real b) : x(a), y(b) {}
    friend Real2 operator-(const Real2& a, const Real2& b) { return {a.x - b.x, a.y - b.y}; }
    friend Real2 operator*(const Real2& a, Real b) { return {a.x * b, a.y * b}; }
};

// Components in another order are member functions; shader_words_begin.h adds their parentheses.
struct Real3 {
    Real x, y, z;
    Real3() = default;
    Real3(Real a, Real b, Real c) : x(a), y(b), z(c) {}
    [[nodiscard]] Real2 componentsXy() const { return {x, y}; }
    [[nodiscard]] Real3 componentsYzx() const { return {y, z, x}; }
    [[nodiscard]] Real3 componentsZxy() const { return {z, x, y}; }
    friend Real3 operator+(const Real3& a, const Real3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Real3 operator-(const Real3& a, const Real3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Real3 operator*(const Real3& a, Real b) { return {a.x * b, a.y * b, a.z * b}; }
    friend Real3 operator*(Real a, const Real3& b) { return b * a; }
};

struct Real4 {
    Real x, y, z, w;
    Real4() = default;
    Real4(Real a, Real b, Real c, Real d) : x(a), y(b), z(c), w(d) {}
    Real4(const Real3& a, Real b) : Real4(a.x, a.y, a.z, b) {}
    [[nodiscard]] Real3 componentsXyz() const { return {x, y, z}; }
    [[nodiscard]] Real3 componentsYzw() const { return {y, z, w}; }
    friend Real4 operator*(Real a, const Real4& b) { return {a * b.x, a * b.y, a * b.z, a * b.w}; }
};

struct int2 {
    int x, y;
    int2(int a, int b) : x(a), y(b) {}
};
struct int3 {
    int x, y, z;
    int3(int a, int b, int c) : x(a), y(b), z(c) {}
};
struct int4 {
    int x, y, z, w;
};
struct uint2 {
    uint x, y;
    uint2() = default;
    uint2(uint a, uint b) : x(a), y(b) {}
    uint2(int a, int b) : uint2(static_cast<uint>(a), static_cast<uint>(b)) {}
};
struct uint4 {
    uint x, y, z, w;
    uint4(uint a, uint b, uint c, uint d) : x(a), y(b), z(c), w(d) {}
    uint4(const uint2& a, const uint2& b) : uint4(a.x, a.y, b.x, b.y) {}
};

inline Real abs(Real a) {
    return std::abs(a.value);
}
inline Real max(Real a, Real b) {
    return std::max(a.value, b.value);
}
inline Real min(Real a, Real b) {
    return std::min(a.value, b.value);
}
inline int min(int a, int b) {
    return std::min(a, b);
}
inline Real floor(Real a) {
    return std::floor(a.value);
}
inline Real2 floor(const Real2& a) {
    return {floor(a.x), floor(a.y)};
}
inline Real3 floor(const Real3& a) {
    return {floor(a.x), floor(a.y), floor(a.z)};
}
inline Real3 clamp(const Real3& a, const Real3& low, const Real3& high) {
    return {min(max(a.x, low.x), high.x), min(max(a.y, low.y), high.y), min(max(a.z, low.z), high.z)};
}
inline Real2 clamp(const Real2& a, const Real2& low, const Real2& high) {
    return {min(max(a.x, low.x), high.x), min(max(a.y, low.y), high.y)};
}
inline Real3 step(const Real3& edge, const Real3& a) {
    return {a.x >= edge.x ? 1 : 0, a.y >= edge.y ? 1 : 0, a.z >= edge.z ? 1 : 0};
}
inline Real inversesqrt(Real a) {
    return 1.0F / std::sqrt(a.value);
}
inline Real rsqrt(Real a) {
    return inversesqrt(a);
}
inline Real uintBitsToFloat(uint bits) {
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}
inline Real asfloat(uint bits) {
    return uintBitsToFloat(bits);
}
template <class T>
T as_type(uint bits) {
    return uintBitsToFloat(bits);
}

/// The texture, borrowed. A read outside it throws.
struct Texels {
    const std::vector<std::uint16_t>* words;
    [[nodiscard]] uint4 at(int x, int y) const {
        constexpr int kWidth = 2048;
        const auto word = [&](std::size_t i) {
            return uint{
                words->at(4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)) + i)};
        };
        return {word(0), word(1), word(2), word(3)};
    }
};
using usampler2D = Texels;
inline uint4 texelFetch(const Texels& texels, const int2& at, int /*level*/) {
    return texels.at(at.x, at.y);
}
template <class T>
struct Texture2D : Texels {
    [[nodiscard]] T Load(const int3& at) const { return this->at(at.x, at.y); }
};
template <class T>
struct texture2d : Texels {
    [[nodiscard]] uint4 read(const uint2& at) const {
        return this->at(static_cast<int>(at.x), static_cast<int>(at.y));
    }
};

}  // namespace relief::stand_in
