// SPDX-License-Identifier: GPL-2.0-or-later
// millwright start: a machine that is up until a signal comes or its display ends; clients run programs on
// it.
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "app/commands.hh"
#include "app/display_program.hh"
#include "app/machine_access.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "hal/core/hal.hh"
#include "machine/loaded_config.hh"
#include "options/command_line.hh"

namespace mw::app {
namespace {

constexpr std::int64_t DISPLAY_END_NS = 5000000000;

struct StartWords {
    std::string ini, homing_module;
    bool isDisplayed = true, isStrict = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line("millwright start MACHINE.ini [options]",
                                  "Brings the machine up by the clock, in emergency stop, and keeps it up "
                                  "for its clients: 'millwright run\n"
                                  "MACHINE.ini PROGRAM.ngc --realtime' then runs programs on it, one after "
                                  "the other. It ends when the\n"
                                  "display does that [DISPLAY]DISPLAY names, or at SIGINT, SIGTERM, SIGHUP "
                                  "or SIGQUIT: everything stops\n"
                                  "along its path, spindles, coolant and the machine go off, parameters are "
                                  "saved. A second SIGINT ends it\n"
                                  "at once.\n");
        line.flag("--no-display", "start no display: up until a signal comes", isDisplayed, false);
        line.text("--homemod", "NAME", "a homing module and its parameters, instead of [EMCMOT]HOMEMOD",
                  homing_module);
        line.flag("--strict", "unknown INI keys are errors", isStrict);
        line.rest(rest);
        line.footer("exit status: 0 ended in order, 1 refused or failed, 2 wrong usage\n");
        return line;
    }
    Result<> parse(const std::vector<std::string> &words) {
        const auto parsed = line().parse(words);
        if (parsed.has_value() && rest.size() != 1) {
            return fail("start needs a machine's INI file", {}, "millwright start MACHINE.ini");
        }
        ini = parsed.has_value() ? rest[0] : "";
        return parsed;
    }
};

/// One `millwright start`, from a configuration that is loaded.
class Start {
  public:
    Start(const StartWords &words, machine::LoadedConfig &loaded, diag::Sink &sink)
        : words_(words), loaded_(loaded), sink_(sink), instance_(hal::default_instance()) {}

    int run() {
        auto status = prepare();
        if (status.has_value()) {
            status = make();
        }
        if (status.has_value()) {
            status = keep_up();
            const auto ended = take_down();
            status = status.has_value() ? ended : status;
        }
        if (!status.has_value()) {
            sink_.failure(status.error());
        }
        return status.has_value() ? 0 : 1;
    }

  private:
    /// What can be refused before anything is made.
    Result<> prepare() {
        if (const auto other = client::Client::connect(instance_); other.has_value()) {
            return fail(fmt::format("a machine is up already as instance '{}': {}", instance_,
                                    other->identity().ini.str()),
                        {}, "end it, or choose another name in MILLWRIGHT_INSTANCE");
        }
        if (words_.isDisplayed && !loaded_.machine.display.empty()) {
            auto display = DisplayProgram::words(loaded_.machine.display, absolute_path(words_.ini));
            if (!display.has_value()) {
                return std::unexpected(display.error());
            }
            display_words_ = std::move(*display);
        }
        return {};
    }

    Result<> make() {
        machine::MachineOptions options;
        options.isStrict = words_.isStrict;
        options.homing_module = words_.homing_module;
        options.isLasting = true;
        auto made =
            machine::make_realtime_machine({loaded_.ini, loaded_.reader, loaded_.machine, sink_}, options);
        if (!made.has_value()) {
            return std::unexpected(made.error());
        }
        machine_ = std::move(*made);
        access_.emplace(*machine_);
        tell_messages();
        fmt::print("{} is up: instance '{}', {}\n", loaded_.machine.name, instance_, words_.ini);
        std::fflush(stdout);
        if (display_words_.empty()) {
            return {};
        }
        auto display = DisplayProgram::start(display_words_, absolute_path(words_.ini));
        if (!display.has_value()) {
            static_cast<void>(take_down());
            return std::unexpected(display.error());
        }
        display_.emplace(std::move(*display));
        return {};
    }

    Result<> keep_up() {
        while (stop_signal == 0) {
            if (auto status = cycle(); !status.has_value()) {
                return status;
            }
            const auto end = display_.has_value() ? display_->end() : std::nullopt;
            if (end.has_value()) {
                return *end == 0 ? Result<>{} : fail(fmt::format("the display ended with status {}", *end));
            }
        }
        sink_.note("stopped by " + stop_signal_name());
        return {};
    }

    Result<> cycle() {
        access_->cycle();
        tell_messages();
        if (auto health = access_->health(); !health.has_value()) {
            return health;
        }
        save_at_end_of_program();
        return {};
    }

    /// Offsets that a program has set outlive whatever comes later, and are seen by the look ahead of the
    /// next one.
    void save_at_end_of_program() {
        const std::uint64_t ended = machine_->task().status().task.programs_ended;
        if (ended == programs_ended_) {
            return;
        }
        programs_ended_ = ended;
        if (const auto saved = machine_->task().save_parameters(); !saved.has_value()) {
            sink_.error(saved.error());
        }
    }

    /// On every way out: what turns or moves first, the display last.
    Result<> take_down() {
        if (access_->health().has_value()) {
            switch_off(*access_);
            tell_messages();
        }
        const auto saved = machine_->task().save_parameters();
        if (display_.has_value()) {
            display_->ask_to_end();
            const std::int64_t deadline_ns = access_->now_ns() + DISPLAY_END_NS;
            while (!display_->end().has_value() && access_->now_ns() < deadline_ns) {
                access_->cycle();  // what it asks for while it ends is answered
            }
            display_->kill();
        }
        access_.reset();
        machine_.reset();
        return saved;
    }

    void tell_messages() {
        while (const auto message = machine_->client().next_message()) {
            const bool isError = message->kind == msgs::MessageKind::OPERATOR_ERROR;
            fmt::print(isError ? stderr : stdout, "{}\n", printable(message->text));
            std::fflush(stdout);
        }
    }

    const StartWords &words_;
    machine::LoadedConfig &loaded_;
    diag::Sink &sink_;
    std::string instance_;
    std::vector<std::string> display_words_;
    std::unique_ptr<machine::Machine> machine_;
    std::optional<OwnMachine> access_;
    std::optional<DisplayProgram> display_;
    std::uint64_t programs_ended_ = 0;
};

}  // namespace

int command_start(const std::vector<std::string> &arguments) {
    StartWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    if (const auto parsed = words.parse(arguments); !parsed.has_value()) {
        fmt::print(stderr, "millwright start: {}\n", parsed.error().str());
        return 2;
    }
    catch_stop_signals();
    diag::Sink sink([](const diag::Diagnostic &d) { fmt::print(stderr, "{}\n", d.str()); });
    auto loaded = machine::LoadedConfig::load(words.ini, sink);
    return loaded == nullptr ? 1 : Start(words, *loaded, sink).run();
}

}  // namespace mw::app
