// SPDX-License-Identifier: GPL-2.0-or-later
// The programs that have been read: the open file, subroutines in files of their own, lines of MDI, and texts
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
    /// Keeps a program under its path, in place of the one that was there.
    Program *keep(std::unique_ptr<Program> program);
    /// `name`.ngc in the first of the folders that has it, read when it is asked for the first time; null
    /// when none has one that can be read.
    Program *find_subroutine(std::string_view name, std::span<const std::string> folders, Names &names);
    /// A line of a file that was read, empty when it was not.
    std::string line_text(const std::string &file, int line) const;
    /// Drops files, not lines of MDI and texts of scripts.
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
