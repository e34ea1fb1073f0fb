// SPDX-License-Identifier: GPL-2.0-or-later
// Tools in a database program ([EMCIO]DB_PROGRAM, requirement G1; LinuxCNC manual, "Tool Database
// Interface"). The program prints its version, then answers lines.
//
//     v2.1                              its first line
//     g          T1 P1 Z0.5 ... FINI    all tools
//     p T1 P1 Z0.6 D2      FINI ...     data of a tool have changed
//     l T1   P0            FINI ...     a tool is in the spindle
//     u T2   P17           FINI ...     a tool is in a pocket (T0 P0: the spindle is empty)
//
// NAK in an answer is a rejection; it is reported, and work continues.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "machine/tools/line_program.hh"
#include "machine/tools/tool_data.hh"

namespace mw::machine {

/// Not realtime; one thread. Only start() waits, unless `awaited` is set. A program that has ended or does
/// not answer in time is reported by name.
class ToolDatabase final : public ToolData {
  public:
    struct Setup {
        std::string command;  ///< program and up to ten arguments
        std::string folder;   ///< working folder of the program; it contains db_spindle.tbl
        tools::Changer changer = tools::Changer::FIXED;
        bool awaited = false;  ///< waits for each answer within the request; for virtual clocks
        /// Writes db_spindle.tbl, and must outlive this object; null: it is written within the call.
        journal::Writer *keeper = nullptr;
        double patience_s = 10;  ///< timeout for its first line, and for each answer
    };
    static Result<std::unique_ptr<task::ToolStore>> start(const Setup &setup, diagnostics::Sink &sink);

    Result<> load_spindle(int index) override;
    Result<> set_entry(int index, const gcode::ToolEntry &entry) override;
    /// Always an error, because the protocol has no line for it.
    Result<> add(const gcode::ToolEntry &entry) override;
    Result<> remove(int index) override;
    bool isSettled() const override {
        return setup_.keeper == nullptr || setup_.keeper->isSettled(spindle_path());
    }
    Result<> reload() override;
    std::optional<Result<>> reload_result() override;
    void step() override;
    std::optional<std::string> take_warning() override;

  private:
    enum class Kind : std::uint8_t { VERSION, TOOLS, CHANGE };
    struct Awaited {
        Kind kind = Kind::CHANGE;
        std::string line;  ///< line that was written
        std::int64_t deadline_ns = 0;
    };
    ToolDatabase(Setup setup, LineProgram program);
    Result<> ask(Kind kind, const std::string &line);
    void take_line(const std::string &line);
    void take_tools();
    void give_up(const std::string &why);
    /// Waits until every request is answered or abandoned.
    void wait();
    std::string spindle_path() const;
    Result<> keep_spindle();
    void find_spindle_tool(tools::Table &read);

    Setup setup_;
    LineProgram program_;
    std::deque<Awaited> awaited_;
    std::string tools_text_;
    std::optional<Result<>> read_{Result<>{}};  ///< result of the last reading
    std::optional<std::string> spindle_text_;   ///< content of db_spindle.tbl; nothing before it is read
    std::deque<std::string> warnings_;
    std::string trouble_;  ///< reason why no more requests are sent
};

}  // namespace mw::machine
