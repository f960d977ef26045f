#include "bake/ground/ground_check_report.h"

#include <vector>

namespace relief {
namespace {

/// "12.3 mm"
std::string millimetres(double metres) {
    return shortNumber(1000.0 * metres) + " mm";
}

std::vector<std::string> nearRow(const std::string& kind, const GroundNear& near) {
    return {kind,
            std::to_string(near.points),
            percentText(near.wrong.total()),
            percentText(near.wrong.false_inside),
            percentText(near.wrong.false_outside),
            millimetres(near.mean),
            millimetres(near.mean_abs),
            millimetres(near.p99),
            millimetres(near.most),
            std::to_string(near.missing)};
}

}  // namespace

std::string groundCheckText(const GroundAccuracy& accuracy, const std::string& name) {
    std::string text =
        name + ": ground of " + accuracy.map + ", " + std::to_string(accuracy.columns) + "x" +
        std::to_string(accuracy.rows) + " samples; " + countText(accuracy.squares, "square") +
        " with ground, " + std::to_string(accuracy.steep) + " of them steeper than 71 degrees, " +
        std::to_string(accuracy.holes) + " without\n" + percentText(accuracy.near.wrong.total()) +
        " of the points within " + lengthText(accuracy.within, "m") +
        " of the surface are on the wrong side; along y it is off by " + millimetres(accuracy.near.mean_abs) +
        " on average, at most " + millimetres(accuracy.near.most) + "\n\n";
    std::vector<std::vector<std::string>> rows = {
        {"points", "number>", "wrong>", "inside by mistake>", "outside>", "mean error>", "absolute>", "99 %>",
         "most>", "no surface>"},
        nearRow("near the surface", accuracy.near)};
    if (accuracy.seams) {
        rows.push_back(nearRow("near seams", *accuracy.seams));
    }
    rows.push_back({"anywhere", std::to_string(accuracy.anywhere_points),
                    percentText(accuracy.anywhere.total()), percentText(accuracy.anywhere.false_inside),
                    percentText(accuracy.anywhere.false_outside), "", "", "", "", ""});
    text += table(rows) + "\n";
    rows = {{"worst place", "tile", "error>", "rise of its square, in sides>"}};
    for (const GroundWorstPlace& place : accuracy.worst) {
        rows.push_back({positionText(place.place), place.node.empty() ? "-" : place.node,
                        place.error ? millimetres(*place.error) : "no surface", shortNumber(place.rise)});
    }
    return text + table(rows);
}

}  // namespace relief
