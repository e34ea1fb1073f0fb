// SPDX-License-Identifier: GPL-2.0-or-later
// Combines a generated file with the edits that a person made in its previous version.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mw::setup {

/// Both sides changed the same lines, or lines next to each other, in different ways.
struct Conflict {
    int line = 0;           ///< first line in the edited text, from 1
    std::string generated;  ///< lines as generated before
    std::string edited;     ///< lines as edited
    std::string wanted;     ///< lines as generated now
};

struct Merged {
    std::string text;                 ///< text in which conflicts are resolved for `Side`
    std::vector<Conflict> conflicts;  ///< empty: `text` has the changes of both sides
};

/// The side whose lines are used in a conflict.
enum class Side { EDITED, WANTED };

/// Applies the changes from `generated` to `edited` and from `generated` to `wanted`.
Merged merge(std::string_view generated, std::string_view edited, std::string_view wanted, Side side);

}  // namespace mw::setup
