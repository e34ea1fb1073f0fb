// SPDX-License-Identifier: GPL-2.0-or-later
// Which block is next: files, subroutine calls, loops and conditions, remapped codes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diag/sink.hh"
#include "interp/ast/program.hh"
#include "interp/codes/executor.hh"
#include "interp/codes/remap.hh"
#include "interp/flow/loop_budget.hh"
#include "interp/interpreter.hh"
#include "interp/scripts/script_host.hh"

namespace mw::interp::detail {

class ScriptView;

class Flow : private ScriptNames {
  public:
    Flow(Executor &executor, Names &names, Canon &target, const Settings &settings);
    ~Flow() override;

    Result<> open(const std::string &path);
    void open_text(const std::string &name, std::string text);
    void close();
    /// One line of the open file, or of a call made by MDI.
    Step step();
    Step execute(std::string_view text);
    /// Back to the top level: the line after the outermost call is next.
    void abort();

    const diag::Diagnostic &error() const { return error_; }
    int line() const { return line_read_; }
    const std::string &file() const;
    /// The block that failed did not decide which one is next: later ones can still be looked at.
    bool isContinuable() const { return isContinuable_; }
    /// Syntax errors of the open file behind a line, at most so many.
    std::vector<diag::Diagnostic> syntax_errors(int after, int most);
    bool isAtFileEnd() const { return program_ == nullptr || next_ > program_->count_lines(); }
    int call_level() const { return static_cast<int>(calls_.size()) - text_levels_; }
    void mark_progress(double seconds) { budget_.mark_progress(seconds); }
    bool isBudgetSpent() const { return budget_.isSpent(); }
    FilePlace place_in_file() const;
    std::string_view subroutine() const;
    std::string line_text(const std::string &file, int line) const;

    // flow_scripts.cc
    /// Opens the script host when the settings or a remap need one, runs the top-level script, and checks
    /// that all that the remaps name exists. Errors name the place in the INI file.
    Result<> load_scripts();
    Result<> begin_scripts();
    /// Ends suspended scripts and the host. Call before the parts that scripts see go away.
    void end_scripts();
    const std::vector<std::string> &warnings() const { return warnings_; }

  private:
    friend class ScriptView;

    struct Repeat {
        int line = 0;  ///< of the O- repeat
        int left = 0;
    };
    enum class CallKind { OWORD, FANUC, REMAP, SCRIPT, TEXT, PROFILE };
    /// How far a remapped code or an O word in a script is.
    enum class Stage { NONE, PROLOG, PROCEDURE, FUNCTION, EPILOG };
    /// Where a program goes on after a call.
    struct Call {
        CallKind kind = CallKind::OWORD;
        Program *program = nullptr;
        int line = 0;  ///< of the call
        NameId label = NO_ID;
        std::vector<Repeat> repeats;
        int sub_line = 0;
        int again = 0;  ///< M98 L: calls still to come
        int sub_end = 0;
        std::optional<PendingBlock> pending;  ///< the rest of a block with a remapped code
        const Remap *remap = nullptr;
        Stage stage = Stage::NONE;
        Program *procedure = nullptr;             ///< of a remap with ngc=
        std::unique_ptr<SuspendedScript> script;  ///< waits for the machine
        bool isScriptDone = false;
        int script_line = 0;  ///< where the script was called
        ScriptOutcome outcome;
        std::vector<double> arguments;  ///< of an O word in a script
        int next = 0;                   ///< TEXT: where the one that had it executed stood
        int reported_line = 0;          ///< TEXT: the line that the script gave

        bool isInScript() const { return stage != Stage::NONE && stage != Stage::PROCEDURE; }
    };
    /// A subroutine's place.
    struct Sub {
        Program *program = nullptr;
        int line = 0;
    };

    Step run_line();
    Step run_block(const BlockView &view);
    Step after_block();
    Step fail_block();
    Step fail_here(std::string message);
    Step end_of_lines();
    Step percent();
    Step finish_mdi();
    void commit();
    void end_program();
    /// Drops all calls above `depth`; suspended scripts among them end.
    void unwind(std::size_t depth = 0);
    std::string call_name(const Call &call) const;

    // flow_budget.cc
    /// A loop begins again: between these lines of the present program, this one included.
    void note_pass(int first, int last) {
        if (budget_.isWatching()) {
            budget_.note_pass({program_, calls_.size(), first, last});
        }
    }
    /// The same for a loop that only its condition ends; false when it never will.
    bool note_conditional_pass(int first, int last);
    Step fail_budget();

    // flow_owords.cc
    bool run_oword(const BlockView &view);
    bool run_oword_kind(const BlockView &view, const OWord &oword);
    bool fail_bad_oword(int line);
    bool run_sub(const OWord &oword);
    bool run_call(const BlockView &view, const OWord &oword);
    bool run_return(const BlockView &view, const OWord &oword);
    bool run_if(const BlockView &view, const OWord &oword);
    bool run_loop(const BlockView &view, const OWord &oword);
    bool run_while(const BlockView &view, const OWord &oword);
    bool run_repeat(const BlockView &view, const OWord &oword);
    bool run_end_repeat(const OWord &oword);
    bool run_leave(const OWord &oword);
    bool condition(const BlockView &view, const OWord &oword, bool &isTrue);
    bool unmatched(const OWord &oword, std::string_view missing);
    int find_after(int line, std::initializer_list<OKind> kinds) const;
    int find_before(int line, std::initializer_list<OKind> kinds) const;
    std::string label_text(const OWord &oword) const;

    // flow_calls.cc
    bool label_of(const BlockView &view, const OWord &oword, NameId &label);
    bool find_sub(NameId label, std::uint32_t column, Sub &sub);
    bool find_fanuc(NameId label, Sub &sub);
    std::string called_from(NameId label) const;
    void note_search();
    Program *load_sub_file(NameId label);
    bool check_depth();
    bool enter(Call &&call, const Sub &sub);
    bool leave(double value, bool hasValue);
    bool pop_call(double value, bool hasValue);
    bool call_fanuc();
    bool return_fanuc();
    bool call_profile();

    // flow_scripts.cc
    bool call_remap();
    bool run_script_oword(NameId label, const double *arguments, std::uint32_t count);
    bool run_script_text();
    Step go_on_with_script();
    bool call_handler(ScriptModule module, const std::string &name);
    bool take_outcome(std::size_t index, ScriptOutcome outcome);
    bool start_stage(Stage stage);
    bool start_procedure();
    bool advance_call();
    void settle_after_script();
    void end_text();
    Result<> check_remap(const Remap &remap);
    Result<> need_scripts(const std::string &what, const SourcePlace &place);
    std::expected<bool, ScriptFault> execute_for_script(std::string_view text, int line);
    std::expected<bool, ScriptFault> run_nested(std::size_t base);
    bool hasName(std::string_view name) const override;
    std::optional<double> value_of(std::string_view name) override;

    Executor &executor_;
    Names &names_;
    Canon &target_;
    const Settings &settings_;
    std::map<std::string, std::unique_ptr<Program>> programs_;
    std::vector<std::unique_ptr<Program>> mdi_;
    Program *program_ = nullptr;
    int next_ = 1;        ///< the line to run next
    int after_line_ = 1;  ///< follows the line that was read
    int line_read_ = 0;
    std::vector<Repeat> repeats_;
    bool isMdi_ = false;
    Program *outer_program_ = nullptr;  ///< the open file while MDI runs
    int outer_next_ = 1;
    std::vector<Call> calls_;
    int text_levels_ = 0;  ///< TEXT among calls_

    std::unique_ptr<ScriptView> view_;
    std::unique_ptr<ScriptHost> scripts_;
    std::vector<std::string> script_names_, warnings_;
    std::vector<std::unique_ptr<Program>> texts_;  ///< that scripts had executed
    std::size_t nested_base_ = 0;                  ///< calls below it belong to scripts that run now
    int script_depth_ = 0;                         ///< scripts that run now, one inside the other
    bool isReadingName_ = false;                   ///< a named parameter's script runs: it may only look
    bool isSyncDue_ = false, isEndDue_ = false;    ///< what a script had executed came to such a point
    std::string script_error_;                     ///< as a script has set it
    LoopBudget budget_;
    bool isContinuable_ = false;
    diag::Diagnostic error_;
};

}  // namespace mw::interp::detail
