// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/rs274.hh"

#include <sys/stat.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/limits.hh"
#include "base/short_text.hh"
#include "base/text.hh"
#include "gcode/canon/print_canon.hh"
#include "gcode/interpreter/ini_keys.hh"
#include "gcode/interpreter/ini_settings.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/plugin.hh"
#include "gcode/interpreter/standalone.hh"

namespace mw::gcode {
namespace {

using namespace gcode;

using Options = StandaloneOptions;

class Run {
  public:
    explicit Run(const Options &options) : options_(options) {}

    Result<> prepare();
    int go();

  private:
    Result<> read_ini();
    Result<> read_tools();
    void report_failure();
    /// Does nothing, because a plug-in makes all calls itself.
    void reset_canon() {
        if (options_.plugin.empty()) {
            canon_->take(OnReset{});
        }
    }
    int run_file();
    int run_mdi();
    int close(int status);

    const Options &options_;
    std::optional<ini::IniFile> ini_;
    Settings settings_;
    Standalone world_;
    std::FILE *out_ = stdout;
    std::unique_ptr<PrintCanon> canon_;
    std::unique_ptr<ProgramInterpreter> interpreter_;
    std::string var_file_;
};

Result<> Run::read_ini() {
    if (options_.ini_file.empty()) {
        return {};
    }
    diagnostics::Sink sink;
    Result<ini::IniFile> ini = ini::IniFile::load(options_.ini_file, sink);
    if (!ini) {
        return std::unexpected(ini.error());
    }
    ini_ = std::move(*ini);
    ini::IniReader reader(*ini_, sink);
    settings_ = settings_from_ini(reader);
    if (const ini::IniEntry *entry = ini_->find("TRAJ", "SPINDLES"); entry != nullptr) {
        const auto count = parse_int(entry->value);
        if (!count || *count < 1 || *count > MAX_SPINDLES) {
            return fail(fmt::format("[TRAJ]SPINDLES must be 1 to {}, not '{}'", MAX_SPINDLES, entry->value),
                        entry->place);
        }
        world_.spindles = static_cast<int>(*count);
    }
    if (const ini::IniEntry *entry = reader.find(ini_key("RS274NGC", "PARAMETER_FILE")); entry != nullptr) {
        var_file_ = ini_->resolve_path(entry->value);
    }
    world_.ini = [this](std::string_view section, std::string_view key) {
        return ini_number(*ini_, section, key);
    };
    for (const diagnostics::Diagnostic &one : sink.all()) {
        fmt::print(stderr, "{}\n", one.str());
    }
    return {};
}

Result<> Run::read_tools() {
    if (options_.tool_file.empty()) {
        world_.table = built_in_tools();
        return {};
    }
    Result<tools::Table> table = tools::Table::load(options_.tool_file);
    if (!table) {
        return std::unexpected(table.error());
    }
    world_.table = std::move(*table);
    return {};
}

/// Uses larger writes than the library's default; on a terminal writes line by line.
void buffer_output(std::FILE *out) {
    constexpr std::size_t SIZE = 65536;
    static char buffer[SIZE];  // stdout uses the buffer until the process ends
    if (::isatty(::fileno(out)) == 0) {
        std::setvbuf(out, buffer, _IOFBF, SIZE);
    }
}

Result<> Run::prepare() {
    if (Result<> done = read_ini(); !done) {
        return done;
    }
    if (Result<> done = read_tools(); !done) {
        return done;
    }
    var_file_ = options_.var_file.empty() ? var_file_ : options_.var_file;
    world_.isBlockDelete = options_.isBlockDelete;
    // LinuxCNC's standalone program uses the entry at index 1 as the tool in the spindle.
    world_.state.current_pocket = 1;
    settings_.initial_units = LengthUnits::MM;
    settings_.tap_order_of_rs274 = true;
    settings_.startup_code.clear();
    settings_.subroutine_path.emplace_back(".");
    if (!options_.output.empty()) {
        out_ = std::fopen(options_.output.c_str(), "w");
        if (out_ == nullptr) {
            return fail(fmt::format("cannot write {}", options_.output));
        }
    }
    buffer_output(out_);
    canon_ = std::make_unique<PrintCanon>(out_);
    if (options_.plugin.empty()) {
        interpreter_ = std::make_unique<Interpreter>(*canon_, world_, world_, world_, settings_);
    } else {
        auto opened = open_plugin(options_.plugin, {*canon_, world_, world_, world_});
        if (!opened) {
            return std::unexpected(opened.error());
        }
        interpreter_ = std::move(*opened);
    }
    if (!var_file_.empty()) {
        if (Result<> done = interpreter_->load_parameters(var_file_); !done) {
            return done;
        }
    }
    return {};
}

/// True when errors have a separate stream or go to a terminal. If they share a file with the canon calls,
/// they are printed as the two lines that programs expect.
bool isForPeople() {
    struct stat out{}, err{};
    const bool known = ::fstat(STDOUT_FILENO, &out) == 0 && ::fstat(STDERR_FILENO, &err) == 0;
    return ::isatty(STDERR_FILENO) == 1 || !known || out.st_dev != err.st_dev || out.st_ino != err.st_ino;
}

/// Prints position, block with a caret and callers; then message and block, which programs read.
void Run::report_failure() {
    std::fflush(out_);
    const diagnostics::Diagnostic &error = interpreter_->error();
    if (options_.stack_shown || isForPeople()) {
        const std::string context = error.context();
        fmt::print(stderr, "{}{}{}\n", error.what.place.str(), context.empty() ? "" : "\n", context);
    }
    // Scripts receive these two lines without changes.
    const bool is_terminal = ::isatty(STDERR_FILENO) == 1;
    const std::string block = short_text(error.line_text);
    fmt::print(stderr, "{}\n{}\n", is_terminal ? printable(error.what.message) : error.what.message,
               is_terminal ? printable(block) : block);
}

/// Runs the whole file. A missing M2, M30 or % at its end is always an error.
int Run::run_file() {
    if (Result<> opened = interpreter_->open(options_.input); !opened) {
        fmt::print(stderr, "{}\n", opened.error().str());
        return 1;
    }
    while (true) {
        switch (interpreter_->step()) {
        case Step::OK:
        case Step::SYNC: break;
        case Step::PROGRAM_END: return 0;
        case Step::FILE_END: reset_canon(); return 0;
        case Step::FAILED:
            report_failure();
            if (options_.on_error == Options::OnError::CONTINUE && !interpreter_->isAtFileEnd()) {
                break;
            }
            if (options_.on_error == Options::OnError::MDI) {
                return run_mdi();
            }
            reset_canon();
            return 1;
        }
    }
}

int Run::run_mdi() {
    std::string line;
    while (std::getline(std::cin, line)) {
        Step step = interpreter_->execute(line);
        while (step == Step::OK || step == Step::SYNC) {
            step = interpreter_->step();
        }
        if (step == Step::FAILED) {
            report_failure();
        } else if (step == Step::PROGRAM_END) {
            break;
        }
        std::fflush(out_);
    }
    return 0;
}

int Run::close(int status) {
    if (options_.ini_file.empty()) {
        reset_canon();
    }
    std::fflush(out_);
    if (!var_file_.empty()) {
        if (const Result<> saved = interpreter_->save_parameters(var_file_); !saved) {
            fmt::print(stderr, "{}\n", saved.error().str());
            status = 1;
        }
    }
    if (out_ != stdout && std::fclose(out_) != 0) {
        fmt::print(stderr, "cannot write {}\n", options_.output);
        status = 1;
    }
    return status;
}

int Run::go() {
    fmt::print(stderr, "executing\n");
    if (const Result<> begun = interpreter_->begin(); !begun) {
        fmt::print(stderr, "{}\n", begun.error().str());
        return close(1);
    }
    for (const std::string &warning : interpreter_->warnings()) {
        fmt::print(stderr, "warning: {}\n", warning);
    }
    return close(options_.input.empty() ? run_mdi() : run_file());
}

}  // namespace

int run_standalone(const StandaloneOptions &options) {
    Run run(options);
    if (const Result<> prepared = run.prepare(); !prepared) {
        fmt::print(stderr, "{}\n", prepared.error().str());
        return 1;
    }
    return run.go();
}

}  // namespace mw::gcode
