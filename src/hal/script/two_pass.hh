// SPDX-License-Identifier: GPL-2.0-or-later
// HAL files that are read twice ([HAL]TWOPASS): the first pass collects the loadrt lines of all files, so
// that several lines for one module become one, and starts programs; the second pass does everything else.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/script/session.hh"

namespace mw::hal::script {

/// The loadrt lines of several files, one per module. `names=` and `personality=` lists are joined, `count=`
/// and `num_chan=` added; any other parameter must be equal in all lines.
class MergedLoads final : public LoadCollector {
  public:
    struct Parameter {
        std::string name;
        std::string value;
        SourcePlace place;
    };
    struct Load {
        std::string module;
        SourcePlace place;  ///< position of its first line
        std::vector<std::string> names;
        std::vector<SourcePlace> name_places;
        std::string count_word;  ///< count or num_chan; empty if neither is set
        std::int64_t count = 0;
        std::vector<std::string> personalities;
        std::vector<Parameter> others;

        /// The words of the combined loadrt command.
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

/// A HAL file in an INI file.
struct HalFileEntry {
    std::string text;   ///< the file and, for scripts, its arguments
    SourcePlace place;  ///< position in the INI file
};

enum class TwoPassReport {
    NOTHING,  ///< prints only failures
    FILES,    ///< also prints the files found
    VERBOSE   ///< also prints each step
};

/// Runs the files through `session` with its options. A file with a line `#NOTWOPASS` (case and blanks are
/// ignored) is excluded from both passes and runs as a whole, also after failures, when the modules of
/// earlier files have been loaded. `keywords` is the value of [HAL]TWOPASS: verbose, nodelete and any others.
Result<> run_two_pass(Session &session, const std::vector<HalFileEntry> &files, const std::string &keywords,
                      TwoPassReport report);

}  // namespace mw::hal::script
