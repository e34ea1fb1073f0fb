// SPDX-License-Identifier: GPL-2.0-or-later
// Which block is next: files, subroutine calls, loops and conditions, remapped codes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diag/sink.hh"
#include "interp/detail/executor.hh"
#include "interp/detail/program.hh"
#include "interp/detail/remap.hh"
#include "interp/interpreter.hh"

namespace mw::interp::detail {

class Flow {
  public:
    Flow(Executor &executor, Names &names, Canon &target, const Settings &settings);

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
    bool isAtFileEnd() const { return program_ == nullptr || next_ > program_->count_lines(); }
    int call_level() const { return static_cast<int>(calls_.size()); }

  private:
    struct Repeat {
        int line = 0;  ///< of the O- repeat
        int left = 0;
    };
    enum class CallKind { OWORD, FANUC, REMAP, PROFILE };
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
    void unwind();

    // flow_owords.cc
    bool run_oword(const BlockView &view);
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
    Program *load_sub_file(NameId label);
    bool check_depth();
    bool enter(Call call, const Sub &sub);
    bool leave(double value, bool hasValue);
    bool call_fanuc();
    bool return_fanuc();
    bool call_remap();
    bool call_profile();

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
    int error_line_ = 0;  ///< when the error is not in the line that was read
    std::vector<Repeat> repeats_;
    bool isMdi_ = false;
    Program *outer_program_ = nullptr;  ///< the open file while MDI runs
    int outer_next_ = 1;
    std::vector<Call> calls_;
    std::uint64_t statements_ = 0;
    diag::Diagnostic error_;
};

}  // namespace mw::interp::detail
