// SPDX-License-Identifier: GPL-2.0-or-later
// Accumulated cutting time and length of each tool, and the state file that keeps them.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::tools {

struct CutLife {
    double time_s = 0;
    double length = 0;  ///< [machine units]
};

/// Tool life. Not thread-safe. File: a line "T5 3600.5 125000" for each tool, seconds and machine units.
class LifeBook {
  public:
    /// Errors name file and line.
    static Result<LifeBook> parse(std::string_view text, const std::string &path);

    void add(int toolno, const CutLife &cut);
    CutLife of(int toolno) const;
    /// Resets the tool of this number.
    void forget(int toolno) { tools_.erase(toolno); }
    std::string text() const;

  private:
    std::map<int, CutLife> tools_;
};

}  // namespace mw::tools
