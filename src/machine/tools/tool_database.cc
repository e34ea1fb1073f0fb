// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tools/tool_database.hh"

#include <chrono>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/duration.hh"
#include "base/text.hh"

namespace mw::machine {
namespace {

constexpr const char *VERSION = "v2.1";
constexpr const char *END = "FINI";
constexpr const char *REFUSAL = "NAK";
constexpr std::size_t MOST_ARGUMENTS = 10;
constexpr std::size_t MOST_TOOLS_BYTES = 1000000;

std::int64_t now_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// A tool and its pocket, in the format of the protocol.
std::string place_line(char letter, int toolno, int pocketno) {
    return fmt::format("{} T{:<3} P{:<3}", letter, toolno, pocketno);
}

bool isFini(const std::string &line) {
    return line.starts_with(END);
}

bool isRefusal(const std::string &line) {
    return line.find(REFUSAL) != std::string::npos;
}

}  // namespace

ToolDatabase::ToolDatabase(Setup setup, LineProgram program)
    : ToolData(tools::Table(setup.changer)), setup_(std::move(setup)), program_(std::move(program)) {
    awaited_.push_back({Kind::VERSION, {}, now_ns() + to_ns(setup_.patience_s)});
}

Result<std::unique_ptr<task::ToolStore>> ToolDatabase::start(const Setup &setup, diagnostics::Sink &sink) {
    const std::vector<std::string> words = split_words(setup.command);
    if (words.empty() || words.size() > MOST_ARGUMENTS + 1) {
        return fail(fmt::format("[EMCIO]DB_PROGRAM = {}: a program and up to {} arguments are expected",
                                setup.command, MOST_ARGUMENTS));
    }
    auto program = LineProgram::start(words, setup.folder);
    if (!program.has_value()) {
        return fail("[EMCIO]DB_PROGRAM: " + program.error().message);
    }
    std::unique_ptr<ToolDatabase> made(new ToolDatabase(setup, std::move(*program)));
    made->wait();
    Result<> read = made->trouble_.empty() ? made->reload() : fail(made->trouble_);
    made->wait();
    read = read.has_value() ? made->read_.value_or(Result<>{}) : read;
    if (!read.has_value()) {
        return fail("[EMCIO]DB_PROGRAM: " + read.error().message);
    }
    while (const auto warning = made->take_warning()) {
        sink.warning(*warning);
    }
    return made;
}

Result<> ToolDatabase::ask(Kind kind, const std::string &line) {
    if (!trouble_.empty()) {
        return fail(trouble_, {}, "correct the program, then end the machine and start it again");
    }
    if (const Result<> written = program_.write(line); !written.has_value()) {
        give_up(written.error().message);
        return fail(trouble_);
    }
    awaited_.push_back({kind, line, now_ns() + to_ns(setup_.patience_s)});
    if (setup_.awaited) {
        wait();
    }
    return {};
}

void ToolDatabase::wait() {
    constexpr double LOOK_S = 0.05;
    for (step(); !awaited_.empty(); step()) {
        program_.sleep(LOOK_S);
    }
}

void ToolDatabase::give_up(const std::string &why) {
    trouble_ = fmt::format("the tool database {}; changes of tool data are not saved", why);
    const bool reading = !read_.has_value();
    if (reading) {
        read_ = fail(trouble_);
    } else {
        warnings_.push_back(trouble_);
    }
    awaited_.clear();
}

void ToolDatabase::step() {
    constexpr int LINES_PER_STEP = 2000;
    for (int i = 0; i < LINES_PER_STEP; ++i) {
        const auto line = program_.read();
        if (!line.has_value()) {
            break;
        }
        take_line(*line);
    }
    if (awaited_.empty() || !trouble_.empty()) {
        return;
    }
    if (const auto ended = program_.ending()) {
        give_up(fmt::format("'{}' cannot be queried: {}", program_.name(), *ended));
    } else if (now_ns() > awaited_.front().deadline_ns) {
        const std::string asked = awaited_.front().kind == Kind::VERSION
                                      ? std::string("does not report its version")
                                      : "does not answer to '" + awaited_.front().line + "'";
        give_up(fmt::format("'{}' {} within {:g} s", program_.name(), asked, setup_.patience_s));
    }
}

void ToolDatabase::take_line(const std::string &line) {
    if (awaited_.empty()) {
        return;  // there is no pending request, and the protocol does not know this line
    }
    const Awaited awaited = awaited_.front();
    switch (awaited.kind) {
    case Kind::VERSION:
        awaited_.pop_front();
        if (trim(line) != VERSION) {
            give_up(fmt::format("'{}' has protocol version '{}', not {}", program_.name(), line, VERSION));
        }
        return;
    case Kind::TOOLS:
        if (isFini(line)) {
            awaited_.pop_front();
            take_tools();
        } else if (isRefusal(line) || tools_text_.size() + line.size() > MOST_TOOLS_BYTES) {
            awaited_.pop_front();
            read_ = fail(
                fmt::format("the tool database '{}' does not report its tools: {}", program_.name(), line));
        } else {
            tools_text_ += line + '\n';
        }
        return;
    case Kind::CHANGE:
        awaited_.pop_front();
        if (isRefusal(line)) {
            warnings_.push_back(
                fmt::format("the tool database '{}' rejects '{}': {}", program_.name(), awaited.line, line));
        }
        return;
    }
}

void ToolDatabase::take_tools() {
    diagnostics::Sink sink;
    tools::Table read = tools::Table::parse_leniently(tools_text_, program_.name(), sink, setup_.changer);
    for (const diagnostics::Diagnostic &one : sink.all()) {
        warnings_.push_back(one.what.str());
    }
    find_spindle_tool(read);
    replace(std::move(read));
    read_ = Result<>{};
}

std::string ToolDatabase::spindle_path() const {
    return (std::filesystem::path(setup_.folder) / "db_spindle.tbl").string();
}

/// For a random changer whose database reports no tool in the spindle: uses the stored tool.
void ToolDatabase::find_spindle_tool(tools::Table &read) {
    if (!spindle_text_.has_value()) {  // only at the start
        spindle_text_ = isRandom() ? read_file(spindle_path()).value_or("") : "";
    }
    if (!isRandom() || read.entry(0).toolno >= 0 || spindle_text_->empty()) {
        return;
    }
    const auto table = tools::Table::parse(*spindle_text_, spindle_path(), tools::Changer::RANDOM);
    const int toolno = table.has_value() ? table->entry(0).toolno : -1;
    read.load_spindle(std::max(0, toolno < 0 ? 0 : read.index_of_tool(toolno)));
}

Result<> ToolDatabase::keep_spindle() {
    if (!isRandom()) {
        return {};
    }
    gcode::ToolEntry in_spindle = entry(0);
    spindle_text_ = in_spindle.toolno < 0 ? std::string() : tools::format_entry(in_spindle) + '\n';
    if (setup_.keeper == nullptr) {
        return write_file_atomically(spindle_path(), *spindle_text_);
    }
    setup_.keeper->keep_file(spindle_path(), *spindle_text_);
    return {};
}

Result<> ToolDatabase::load_spindle(int index) {
    const int unloaded = entry(0).toolno;
    Result<> done = ToolData::load_spindle(index);
    if (!done.has_value() || (isRandom() && index == 0)) {
        return done;
    }
    if (!isRandom()) {
        const int loaded = entry(0).toolno;
        return ask(Kind::CHANGE, loaded > 0 ? place_line('l', loaded, 0) : place_line('u', 0, 0));
    }
    done = keep_spindle();
    if (unloaded >= 0) {
        const Result<> told = ask(Kind::CHANGE, place_line('u', unloaded, index));
        done = done.has_value() ? told : done;
    }
    const Result<> told = ask(Kind::CHANGE, place_line('l', entry(0).toolno, 0));
    return done.has_value() ? told : done;
}

Result<> ToolDatabase::set_entry(int index, const gcode::ToolEntry &entry) {
    const Result<> done = ToolData::set_entry(index, entry);
    const bool is_copy = index == 0 && !isRandom();
    if (!done.has_value() || is_copy) {
        return done;
    }
    gcode::ToolEntry changed = ToolData::entry(index_of_tool(entry.toolno));
    changed.comment.clear();
    return ask(Kind::CHANGE, "p " + tools::format_entry(changed));
}

Result<> ToolDatabase::add(const gcode::ToolEntry &entry) {
    return fail(fmt::format("tool {} was not added: the tool database '{}' contains the tools. Add it there, "
                            "then read the table again",
                            entry.toolno, program_.name()));
}

Result<> ToolDatabase::remove(int index) {
    const bool present = index >= 0 && index < count();
    return fail(fmt::format("tool {} was not removed: the tool database '{}' contains the tools. Remove it "
                            "there, then read the table again",
                            present ? entry(index).toolno : -1, program_.name()));
}

Result<> ToolDatabase::reload() {
    tools_text_.clear();
    read_.reset();
    const Result<> asked = ask(Kind::TOOLS, "g");
    if (!asked.has_value()) {
        read_ = asked;
    }
    return asked;
}

std::optional<Result<>> ToolDatabase::reload_result() {
    return read_;
}

std::optional<std::string> ToolDatabase::take_warning() {
    if (warnings_.empty()) {
        return std::nullopt;
    }
    std::string first = std::move(warnings_.front());
    warnings_.pop_front();
    return first;
}

}  // namespace mw::machine
