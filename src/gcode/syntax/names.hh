// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers for names of parameters and labels, so that running a program compares no texts.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>

#include "gcode/syntax/ast.hh"

namespace mw::gcode::detail {

class Names {
  public:
    /// The number of a name, which is not changed (callers remove case and blanks where the language does).
    NameId intern(std::string_view name);
    const std::string &text(NameId id) const { return texts_[id]; }
    std::size_t size() const { return texts_.size(); }

  private:
    std::deque<std::string> texts_;  // has stable addresses: the map's keys are views into it
    std::unordered_map<std::string_view, NameId> ids_;
};

}  // namespace mw::gcode::detail
