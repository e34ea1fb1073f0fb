// SPDX-License-Identifier: GPL-2.0-or-later
// canterp: an interpreter plug-in. It reads canon calls as rs274 prints them, one per line: a counter and a
// block number, which are ignored, then NAME(arguments).
#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "gcode/analysis/canterp/calls.hh"
#include "gcode/interpreter/program_interpreter.hh"

namespace mw::gcode::canterp {
namespace {

class Canterp final : public ProgramInterpreter {
  public:
    explicit Canterp(const PluginParts &parts) : canon_(parts.canon) {}

    Result<> begin() override { return {}; }

    Result<> open(const std::string &path) override {
        Result<std::string> text = read_file(path);
        if (!text) {
            return std::unexpected(text.error());
        }
        close();
        file_ = path;
        text_ = std::move(*text);
        return {};
    }

    void close() override {
        text_.clear();
        file_.clear();
        at_ = 0;
        line_ = 0;
    }

    Step step() override {
        if (isAtFileEnd()) {
            return Step::FILE_END;
        }
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        const std::string_view line(text_.data() + at_, end - at_);
        at_ = end + 1;
        ++line_;
        return run(line);
    }

    Step execute(std::string_view line) override {
        // MDI lines have no columns before the call.
        const std::string whole = "0 N " + std::string(line);
        const Step step = run(whole);
        return step == Step::OK ? Step::FILE_END : step;
    }

    void synch() override {}
    void abort() override { at_ = text_.size(); }
    const diagnostics::Diagnostic &error() const override { return error_; }
    int line() const override { return line_; }
    const std::string &file() const override { return file_; }
    bool isAtFileEnd() const override { return at_ >= text_.size(); }

  private:
    Step run(std::string_view line) {
        Call call;
        const Kind kind = take_apart(line, call);
        if (kind == Kind::NOTHING) {
            return Step::OK;
        }
        if (kind == Kind::BAD) {
            return failed({"a line must be: counter, block number, NAME(arguments)", {}, {}}, line);
        }
        canon_.begin_block({file_, line_, line_, 0, line, false});
        if (const Result<> made = make_call(call, canon_, plane_); !made) {
            return failed(made.error(), line);
        }
        const bool is_change = call.name == "CHANGE_TOOL";
        return call.name == "PROGRAM_END" ? Step::PROGRAM_END : (is_change ? Step::SYNC : Step::OK);
    }

    Step failed(Error what, std::string_view line) {
        what.message = "canterp: " + what.message;
        what.place.file = file_;
        what.place.line = line_;
        error_ = {diagnostics::Severity::ERROR, std::move(what), {}, std::string(line)};
        return Step::FAILED;
    }

    Canon &canon_;
    std::string file_, text_;
    std::size_t at_ = 0;
    int line_ = 0;
    Plane plane_ = Plane::XY;
    diagnostics::Diagnostic error_;
};

}  // namespace
}  // namespace mw::gcode::canterp

extern "C" {
__attribute__((visibility("default"))) extern const int millwright_plugin_version;
const int millwright_plugin_version = mw::gcode::PLUGIN_VERSION;

__attribute__((visibility("default"))) mw::gcode::ProgramInterpreter *
makeInterp(const mw::gcode::PluginParts &parts) {
    return new mw::gcode::canterp::Canterp(parts);
}
}
