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

/// An object of a report that has no struct of its own, made by the next two.
template <class Visit>
struct FieldGroup {
    Visit visit_fields;
    bool nullable = false;
    bool present = true;  ///< else it is null
};
/// visit("bounds", group([&](auto& visit) { visit("min", …); }), {…})
template <class Visit>
[[nodiscard]] FieldGroup<Visit> group(Visit visit_fields) {
    return {std::move(visit_fields)};
}
/// The same or null. For its schema the fields are visited although it is not present.
template <class Visit>
[[nodiscard]] FieldGroup<Visit> groupIf(bool present, Visit visit_fields) {
    return {std::move(visit_fields), true, present};
}
template <class Visitor, class Visit>
void fields(Visitor& visit, const FieldGroup<Visit>& all) {
    all.visit_fields(visit);
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
