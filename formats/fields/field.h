// SPDX-License-Identifier: Apache-2.0
// Helpers for the fields() of reports, in addition to formats/base/field.h. Relief never parses reports, so their
// fields() may visit expressions as well as members.
#pragma once

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/field.h"

namespace relief {

/// Makes an object of fields: visit("bounds", group([&](FieldVisitor& visit) { visit("min", …); }), {…})
/// \param visit_fields  borrowed
template <class Visit>
[[nodiscard]] FieldGroup group(const Visit& visit_fields) {
    return {&visit_fields,
            [](const void* of, FieldVisitor& visit) { (*static_cast<const Visit*>(of))(visit); }};
}
/// Like group(), but written as null if not `present`. The schema contains the fields in either case.
template <class Visit>
[[nodiscard]] FieldGroup groupIf(bool present, const Visit& visit_fields) {
    FieldGroup made = group(visit_fields);
    made.nullable = true;
    made.present = present;
    return made;
}

/// Returns the value if the condition holds, otherwise nullopt (null in JSON).
template <class T>
[[nodiscard]] std::optional<T> onlyIf(bool condition, T value) {
    return condition ? std::optional<T>(std::move(value)) : std::nullopt;
}
/// Constructs a report struct for each element: `viewsOf<PlaceReport>(places, collider)` returns PlaceReport{place,
/// collider} for each place.
template <class View, class T, class... More>
[[nodiscard]] std::vector<View> viewsOf(const std::vector<T>& all, const More&... more) {
    std::vector<View> views;
    for (const T& one : all) {
        views.push_back(View{one, more...});
    }
    return views;
}
/// Returns nullopt (null) if a number is infinite or NaN.
[[nodiscard]] inline std::optional<double> finite(double value) {
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}
/// Returns nullopt (null) if a text is empty.
[[nodiscard]] inline std::optional<std::string_view> nonEmpty(std::string_view text) {
    return text.empty() ? std::nullopt : std::optional(text);
}

/// An empty T. References in report structs default to it, so that a schema can be derived from a default-constructed
/// struct.
template <class T>
inline const T kNone{};

}  // namespace relief
