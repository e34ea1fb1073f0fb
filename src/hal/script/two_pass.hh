// SPDX-License-Identifier: GPL-2.0-or-later
// HAL files that are gone through twice ([HAL]TWOPASS): first the loadrt lines of all files are collected, so
// that several lines for one module become one, and programs are started; then everything else is done.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/script/session.hh"

namespace mw::hal::script {

/// The loadrt lines of several files, one per module. `names=` and `personality=` lists are joined, `count=`
/// and `num_chan=` added; any other parameter must be the same wherever it is given.
class MergedLoads final : public LoadCollector {
  public:
    struct Parameter {
        std::string name;
        std::string value;
        SourcePlace place;
    };
    struct Load {
        std::string module;
        SourcePlace place;  ///< of its first line
        std::vector<std::string> names;
        std::vector<SourcePlace> name_places;
        std::string count_word;  ///< count or num_chan; empty without
        std::int64_t count = 0;
        std::vector<std::string> personalities;
        std::vector<Parameter> others;

        /// The words of the one loadrt command.
        std::vector<std::string> words() const;
    };

    Result<> add(const Call &loadrt) override;
    /// In the order of their first lines.
    const std::vector<Load> &loads() const { return loads_; }

  private:
    Result<> add_names(Load &load, const Parameter &parameter);
    Result<> add_count(Load &load, const Parameter &parameter);
    Result<> add_other(Load &load, const Parameter &parameter);

    std::vector<Load> loads_;
};

/// A HAL file as an INI file names it.
struct HalFileEntry {
    std::string text;   ///< the file and, for scripts, its arguments
    SourcePlace place;  ///< in the INI file
};

enum class TwoPassReport {
    NOTHING,  ///< failures only
    FILES,    ///< the files found
    VERBOSE   ///< and each step
};

/// Runs the files through `session`, whose options say how. A file with a line `#NOTWOPASS` (case and blanks
/// do not matter) is left out of both passes and runs as a whole, keeping going after failures, when the
/// modules of the files before it have been loaded. `keywords` is the value of [HAL]TWOPASS: verbose,
/// nodelete and any others.
Result<> run_two_pass(Session &session, const std::vector<HalFileEntry> &files, const std::string &keywords,
                      TwoPassReport report);

}  // namespace mw::hal::script
