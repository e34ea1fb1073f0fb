// SPDX-License-Identifier: GPL-2.0-or-later
// Combines a generated file with the edits that a person made in its last version.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mw::setup {

/// Both sides changed the same lines, or lines next to each other, in different ways.
struct Conflict {
    int line = 0;           ///< first line in the edited text, from 1
    std::string generated;  ///< lines as they were generated
    std::string edited;     ///< lines as the person left them
    std::string wanted;     ///< lines as they are generated now
};

struct Merged {
    std::string text;                 ///< conflicts are resolved for `Side`
    std::vector<Conflict> conflicts;  ///< empty: both sides' changes are in `text`
};

/// The side whose lines are used where both have changed the same lines.
enum class Side { EDITED, WANTED };

/// Changes of lines from `generated` to `edited` and from `generated` to `wanted`, together.
Merged merge(std::string_view generated, std::string_view edited, std::string_view wanted, Side side);

}  // namespace mw::setup
