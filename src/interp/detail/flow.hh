// SPDX-License-Identifier: GPL-2.0-or-later
// Which block is next: files, subroutine calls, loops and conditions.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "diag/sink.hh"
#include "interp/detail/executor.hh"
#include "interp/detail/program.hh"
#include "interp/interpreter.hh"

namespace mw::interp::detail {

class Flow {
  public:
    Flow(Executor &executor, Names &names, Canon &target, const Settings &settings);

    Result<> open(const std::string &path);
    void close();
    /// One line of the open file, or of a call made by MDI.
    Step step();
    Step execute(std::string_view text);
    void abort();

    const diag::Diagnostic &error() const { return error_; }
    int line() const { return line_read_; }
    const std::string &file() const;
    int call_level() const { return static_cast<int>(calls_.size()); }

  private:
    struct Repeat {
        int line = 0;  ///< of the O- repeat
        int left = 0;
    };
    /// Where a program goes on after a call.
    struct Call {
        Program *program = nullptr;
        int line = 0;  ///< of the call
        NameId label = NO_ID;
        std::vector<Repeat> repeats;
        bool isFanuc = false;
        int sub_line = 0;
        int repeats_left = 0;  ///< M98 L
    };

    Step run_line();
    Step run_block(const BlockView &view);
    Step fail_block(const BlockView *view);
    Step end_of_file();
    bool run_oword(const BlockView &view);
    void commit();

    Executor &executor_;
    Names &names_;
    Canon &target_;
    const Settings &settings_;
    std::map<std::string, std::unique_ptr<Program>> programs_;
    std::vector<std::unique_ptr<Program>> mdi_;
    Program *program_ = nullptr;
    int next_ = 1;  ///< the line to run next
    int line_read_ = 0;
    bool isMdi_ = false;
    bool isFirstPercentSeen_ = false;
    std::vector<Call> calls_;
    std::uint64_t statements_ = 0;
    diag::Diagnostic error_;
};

}  // namespace mw::interp::detail
