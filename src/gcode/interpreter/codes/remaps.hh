// SPDX-License-Identifier: GPL-2.0-or-later
// Codes that are remapped to a subroutine or a script ([RS274NGC]REMAP): the lines, the running procedures,
// and the block that a procedure has interrupted.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/interpreter/settings.hh"

namespace mw::gcode::detail {

/// A word of the argspec.
struct RemapWord {
    char letter = 'p';  ///< lower case
    bool required = false;
};

struct Remap {
    std::string name;  ///< in upper case: "M400", "G88.1"
    Code code;         ///< row in the table of codes
    int modal_group = 0;
    std::string ngc;               ///< name of the subroutine (ngc=), or
    std::string function;          ///< name of the script function (py=, python=)
    std::string prolog, epilog;    ///< script functions around the subroutine
    std::string argspec;           ///< as written
    std::vector<RemapWord> words;  ///< in the order of the argspec
    bool positional = false;       ///< @: words become #1, #2, ...
    bool needs_feed = false;       ///< >
    bool needs_speed = false;      ///< ^
    bool wants_line = false;       ///< n: the line number becomes #<n>
    SourcePlace place;
    std::string refusal;  ///< reason why the line has no effect

    bool needsScripts() const { return !function.empty() || !prolog.empty() || !epilog.empty(); }
    /// Name of the procedure in messages.
    const std::string &target() const { return ngc.empty() ? function : ngc; }
    ScriptRemap described() const;
};

/// A block that waits for the subroutine of one of its codes.
struct PendingBlock {
    const Remap *remap = nullptr;  ///< remap of that code
    BlockValues values;
    std::size_t next = 0;  ///< index of the code to continue with
    std::string comment;
    int line = 0, sequence = -1;
};

/// Reads one REMAP line, as in "M400 modalgroup=5 argspec=PQ ngc=rm400". Errors name file, line and column.
Result<Remap> parse_remap(const RemapLine &line);

class Remaps {
  public:
    Remaps() = default;
    Remaps(Remaps &&) = default;  // rows point to their remaps
    Remaps(const Remaps &) = delete;
    Remaps &operator=(Remaps &&) = delete;
    Remaps &operator=(const Remaps &) = delete;

    /// Reads the lines, once, before the first program. Errors name file, line and column.
    Result<> load(std::span<const RemapLine> lines);
    const std::vector<Remap> &all() const { return all_; }
    /// Reasons why lines have no effect.
    const std::vector<std::string> &refused() const { return refused_; }
    /// The row of a remapped code; null for any other code, and while the code's own procedure runs.
    const Code *find(GCode code) const;

    /// The procedure of `remap` begins at a call level (from 1).
    void begin(const Remap &remap, std::size_t level) { running_.push_back({&remap, level, 0}); }
    /// Ends the procedures above a call level.
    void end_above(std::size_t level);
    bool isAnyRunning() const { return !running_.empty(); }
    int count_running() const { return static_cast<int>(running_.size()); }
    /// Counts a code that is executed with its built-in meaning, for the procedures that remap it.
    void count_builtin(GCode code);
    /// How often the procedure of the `nth` running remap (from 1) has used the built-in meaning of its code.
    int builtin_uses(int nth) const { return running_[static_cast<std::size_t>(nth) - 1].builtins; }
    /// Explains that a remapped code has no built-in meaning here; empty if that is not the reason.
    std::string recursion_text(GCode code) const;

    /// A block has reached a remapped code.
    void interrupt(PendingBlock block) { interrupted_ = std::move(block); }
    /// Returns the interrupted block, to continue it after the procedure.
    PendingBlock take_interrupted();
    void drop_interrupted() { interrupted_.reset(); }

  private:
    struct Running {
        const Remap *remap = nullptr;
        std::size_t level = 0;
        int builtins = 0;
    };
    bool isRunning(const Remap &remap) const;

    std::vector<Remap> all_;
    std::vector<std::string> refused_;
    std::vector<Running> running_;
    std::optional<PendingBlock> interrupted_;
};

/// Words that the argspec requires and the block lacks, separated by commas; empty when none is missing.
std::string missing_words(const PendingBlock &block, const State &state);
/// Passes words of the block as local names of the procedure, or as #1, #2, ... in the order of the argspec.
void pass_words(const PendingBlock &block, bool count_named, Parameters &parameters, Names &names);

}  // namespace mw::gcode::detail
