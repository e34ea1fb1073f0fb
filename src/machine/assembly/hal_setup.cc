// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/assembly/hal_setup.hh"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "base/stop_signals.hh"
#include "base/text.hh"
#include "hal/script/session.hh"
#include "hal/script/two_pass.hh"

namespace mw::machine {
namespace {

namespace script = hal::script;

/// Values for [SECTION]KEY. Each key that a HAL file uses becomes known.
class IniValues final : public script::IniLookup {
  public:
    explicit IniValues(ini::IniReader &reader) : reader_(reader) {}
    std::optional<std::string> find(std::string_view section, std::string_view name) const override {
        reader_.use_section(section);
        const ini::IniEntry *entry = reader_.file().find(section, name);
        if (entry == nullptr) {
            return std::nullopt;
        }
        // Only keys of known sections need to become known, because custom sections cause no warnings.
        reader_.know_if_ours(section, name);
        return entry->value;
    }
    std::vector<std::string> names(std::string_view section) const override {
        return reader_.file().keys(section);
    }
    std::vector<std::string> values(std::string_view section, std::string_view name) const override {
        std::vector<std::string> values;
        for (const ini::IniEntry *entry : reader_.file().find_all(section, name)) {
            values.push_back(entry->value);
        }
        return values;
    }
    std::vector<std::string> sections() const override { return reader_.file().sections(); }

  private:
    ini::IniReader &reader_;
};

/// Output of commands goes to standard output; errors and warnings go to the sink.
class SinkOutput final : public script::Output {
  public:
    explicit SinkOutput(diagnostics::Sink &sink) : sink_(sink) {}
    void data(std::string_view text) override { fmt::print("{}", text); }
    void info(std::string_view) override {}
    void note(std::string_view text) override { fmt::print("{}\n", text); }
    void warning(const Error &warning) override {
        sink_.warning(warning.message, warning.place, warning.hint);
    }
    void error(const Error &error) override { sink_.error(error); }

  private:
    diagnostics::Sink &sink_;
};

/// Parts of this process take precedence over programs of the system.
class RealtimePrograms final : public script::ProgramHost {
  public:
    RealtimePrograms(script::InProcessProgramHost &parts, std::set<std::string> names,
                     script::ProgramHost &system)
        : parts_(parts), names_(std::move(names)), system_(system) {}
    Result<script::ProgramStart> start(const script::ProgramRequest &request) override {
        const bool is_part = !request.argv.empty() && names_.count(script::base_name(request.argv[0])) > 0;
        return is_part ? parts_.start(request) : system_.start(request);
    }
    Result<> stop(const std::string &component) override { return system_.stop(component); }
    Result<> stop_all() override { return system_.stop_all(); }
    Result<> wait_for_end(const std::string &component) override { return system_.wait_for_end(component); }

  private:
    script::InProcessProgramHost &parts_;
    std::set<std::string> names_;
    script::ProgramHost &system_;
};

/// Loads a user's module instead of `ours` (homemod, tpmod), and checks that it is of this type.
Result<> load_instead(script::Session &session, const std::string &ours, const HalStep &module) {
    const std::vector<std::string> words = split_words(module.text);
    if (words.empty() || words[0] == ours) {
        return {};
    }
    const std::string place = module.place.str();
    Result<> done = session.run_text("loadrt " + module.text, place);
    done = done ? session.run_text("loadrt " + ours + " replaced_by=" + words[0], place) : done;
    return done ? session.run_text("unloadrt " + ours, place) : done;
}

Result<> run_file_step(script::Session &session, const HalStep &step) {
    const std::vector<std::string> words = split_words(step.text);
    if (words.empty()) {
        return fail("[HAL]HALFILE names no file", step.place);
    }
    const std::string &name = words[0];
    if (!session.find_file(name).has_value()) {
        return fail("HAL file '" + name + "' is not found", step.place,
                    "searched in the folder of the INI file and in the library of HAL files");
    }
    return session.run_file(name, {words.begin() + 1, words.end()});
}

/// Runs all files in two passes, then the single commands.
Result<> run_two_pass_steps(script::Session &session, const std::vector<HalStep> &steps,
                            const std::string &keywords) {
    std::vector<script::HalFileEntry> files;
    for (const HalStep &step : steps) {
        if (step.kind == HalStep::Kind::FILE) {
            files.push_back({step.text, step.place});
        }
    }
    auto done = script::run_two_pass(session, files, keywords, script::TwoPassReport::NOTHING);
    for (const HalStep &step : steps) {
        if (done && step.kind == HalStep::Kind::COMMAND) {
            done = session.run_text(step.text, step.place.str());
        }
    }
    return done;
}

/// Runs the steps. If the session continues after errors, so do the steps, and each failure is reported once.
Result<> run_steps(script::Session &session, const std::vector<HalStep> &steps, diagnostics::Sink &sink) {
    for (const HalStep &step : steps) {
        const int errors_before = sink.count_errors();
        const auto done = step.kind == HalStep::Kind::FILE ? run_file_step(session, step)
                                                           : session.run_text(step.text, step.place.str());
        if (!done && !session.options().keepsGoing) {
            return done;
        }
        if (!done && sink.count_errors() == errors_before) {
            sink.error(done.error());
        }
    }
    return {};
}

}  // namespace

namespace {

/// Sets the environment variables that scripts of HAL files read: this INI file, and the library from which
/// they source other scripts. A library set by the user is kept.
void offer_to_scripts(const std::string &ini, const std::vector<std::string> &library) {
    std::error_code ignored;
    const auto whole = std::filesystem::absolute(ini, ignored);
    ::setenv("INI_FILE_NAME", whole.c_str(), 1);
    for (const std::string &folder : library) {
        if (std::filesystem::is_directory(folder, ignored)) {
            ::setenv("HALLIB_DIR", folder.c_str(), 0);
            ::setenv("HALLIB_PATH", (".:" + folder).c_str(), 0);
            return;
        }
    }
}

}  // namespace

Result<> HalSetup::run() {
    const IniValues ini(parts_.reader);
    SinkOutput output(parts_.sink);
    script::InProcessProgramHost parts;
    parts.add_part("hal_manualtoolchange",
                   [this](const script::ProgramRequest &) { return on_tool_change_program(); });
    if (programs_ == nullptr) {
        // The driver simulates its board in this process.
        parts.add_part("hm2-board", [](const script::ProgramRequest &) { return Result<>(); });
    }
    std::optional<RealtimePrograms> programs;
    if (programs_ != nullptr) {
        programs.emplace(parts, std::set<std::string>{"hal_manualtoolchange"}, *programs_);
    }
    const bool is_virtual = host_.hal().isVirtual();
    script::SessionOptions session_options;
    session_options.has_placeholders = is_virtual;
    session_options.ini = &ini;
    session_options.stop = &stop_signal;  // a program that never becomes ready must not block the start
    session_options.keepsGoing = options_.kept_going;
    session_options.folders = options_.hal_folders;
    session_options.folders.push_back(parts_.ini.folder());
    session_options.library = options_.hal_library;
    for (const std::string &folder : script::default_library()) {
        session_options.library.push_back(folder);
    }
    offer_to_scripts(parts_.ini.path(), session_options.library);
    script::ProgramHost *const program_host =
        programs ? static_cast<script::ProgramHost *>(&*programs) : &parts;
    script::Session session(host_, *program_host, output, session_options);
    const int errors_before = parts_.sink.count_errors();
    const auto chosen = [](const std::string &asked, const char *option, const HalStep &of_file) {
        return asked.empty() ? of_file : HalStep{HalStep::Kind::COMMAND, asked, {option, 0, 0}};
    };
    Result<> done = load_instead(session, "homemod",
                                 chosen(options_.homing_module, "--homemod", parts_.config.homing_module));
    if (done) {
        done = load_instead(session, "tpmod",
                            chosen(options_.planner_module, "--tpmod", parts_.config.planner_module));
    }
    if (done) {
        done = parts_.config.two_pass.empty()
                   ? run_steps(session, parts_.config.hal_steps, parts_.sink)
                   : run_two_pass_steps(session, parts_.config.hal_steps, parts_.config.two_pass);
    }
    if (!done) {
        // The session reports its own failures, with the line of the HAL file.
        Error error = done.error();
        error.isTold = parts_.sink.count_errors() > errors_before;
        return std::unexpected(std::move(error));
    }
    for (const std::string &text : session.left_out()) {
        parts_.sink.warning(text);
    }
    return {};
}

}  // namespace mw::machine
