// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

NameId Names::intern(std::string_view name) {
    if (const auto found = ids_.find(name); found != ids_.end()) {
        return found->second;
    }
    const NameId id = static_cast<NameId>(texts_.size());
    texts_.emplace_back(name);
    ids_.emplace(texts_.back(), id);
    return id;
}

}  // namespace mw::gcode::detail
