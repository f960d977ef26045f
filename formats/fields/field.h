// SPDX-License-Identifier: Apache-2.0
// What fields() of reports need beside formats/base/field.h: a report is only written, and visits expressions as well as
// members.
#pragma once

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/field.h"

namespace relief {

/// visit("bounds", group([&](FieldVisitor& visit) { visit("min", …); }), {…})
/// \param visit_fields  borrowed
template <class Visit>
[[nodiscard]] FieldGroup group(const Visit& visit_fields) {
    return {&visit_fields,
            [](const void* of, FieldVisitor& visit) { (*static_cast<const Visit*>(of))(visit); }};
}
/// The same or null. For its schema the fields are visited although it is not present.
template <class Visit>
[[nodiscard]] FieldGroup groupIf(bool present, const Visit& visit_fields) {
    FieldGroup made = group(visit_fields);
    made.nullable = true;
    made.present = present;
    return made;
}

/// Null where the condition is false.
template <class T>
[[nodiscard]] std::optional<T> onlyIf(bool condition, T value) {
    return condition ? std::optional<T>(std::move(value)) : std::nullopt;
}
/// A view of each: `viewsOf<PlaceReport>(places, collider)` makes PlaceReport{place, collider} of each place.
template <class View, class T, class... More>
[[nodiscard]] std::vector<View> viewsOf(const std::vector<T>& all, const More&... more) {
    std::vector<View> views;
    for (const T& one : all) {
        views.push_back(View{one, more...});
    }
    return views;
}
/// Null where a number is infinite or NaN.
[[nodiscard]] inline std::optional<double> finite(double value) {
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}
/// Null where a text is empty.
[[nodiscard]] inline std::optional<std::string_view> nonEmpty(std::string_view text) {
    return text.empty() ? std::nullopt : std::optional(text);
}

/// An empty T. References of a view are initialized with it, so that a schema can be made from the view's type alone.
template <class T>
inline const T kNone{};

}  // namespace relief
