// SPDX-License-Identifier: GPL-2.0-or-later
// The programs that have been read: the open file, subroutines in separate files, lines of MDI, and texts
// that scripts have executed.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

class ProgramFiles {
  public:
    /// Stores a program under its path and replaces an earlier one.
    Program *keep(std::unique_ptr<Program> program);
    /// `name`.ngc in the first of the folders that has it, read on first use; null when none can be read.
    Program *find_subroutine(std::string_view name, std::span<const std::string> folders, Names &names);
    /// A line of a file; empty when the file has not been read.
    std::string line_text(const std::string &file, int line) const;
    /// Drops files, but keeps lines of MDI and texts of scripts.
    void close_files() { files_.clear(); }

    Program *keep_mdi(std::string_view line, Names &names);
    void drop_mdi() { mdi_.clear(); }
    Program *keep_script_text(std::string_view text, Names &names);
    void drop_script_texts() { texts_.clear(); }

  private:
    std::map<std::string, std::unique_ptr<Program>, std::less<>> files_;
    std::vector<std::unique_ptr<Program>> mdi_, texts_;
};

}  // namespace mw::gcode::detail
