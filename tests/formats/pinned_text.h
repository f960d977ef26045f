// All that a container says, as text: what tests/formats/pinned/ holds beside each of its containers.
#pragma once

#include <string>

#include "formats/collider.h"

namespace relief::test {

/// Every number of a collider, its texels in hexadecimal, row by row; and what it says of points in and about its bounds.
/// Floats have nine digits, by which they are read back exactly.
[[nodiscard]] std::string pinnedText(const Collider& collider);

}  // namespace relief::test
