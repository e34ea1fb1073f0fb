// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/start/machine_start.hh"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "base/duration.hh"
#include "base/output_relay.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "base/whole_path.hh"
#include "clients/screen/files/filter.hh"
#include "hal/core/instance.hh"
#include "machine/journal/writer.hh"
#include "machine/task/task.hh"
#include "messages/client/shown_message.hh"

namespace mw::programs {
namespace {

/// Maximum time for started programs to end by themselves, and for the file of [HAL]SHUTDOWN.
constexpr std::int64_t END_NS = 5000000000;

}  // namespace

MachineStart::MachineStart(StartSettings settings, machine::LoadedConfig &loaded, diagnostics::Sink &sink)
    : settings_(std::move(settings)), loaded_(loaded), sink_(sink), instance_(hal::default_instance()) {}

int MachineStart::run() {
    if (const std::string why = OutputRelay::begin(); !why.empty()) {
        sink_.warning("a stopped terminal can delay the machine: " + why);
    }
    const int status = run_machine();
    OutputRelay::end();
    return status;
}

int MachineStart::run_machine() {
    auto status = prepare();
    if (status.has_value()) {
        status = make();
    }
    if (status.has_value()) {
        status = keep_up();
        if (!status.has_value()) {
            // Posted before the programs are ended, which may take seconds.
            machine_->task().post(messages::MessageKind::OPERATOR_ERROR, status.error().str());
            sink_.failure(status.error());
            static_cast<void>(take_down());
            return 1;
        }
        status = take_down();
    }
    if (!status.has_value()) {
        sink_.failure(status.error());
        return 1;
    }
    return display_status_.value_or(0);
}

/// Checks that need no machine.
Result<> MachineStart::prepare() {
    if (const auto other = client::Client::connect(instance_); other.has_value()) {
        return fail(fmt::format("a machine is already running as instance '{}': {}", instance_,
                                other->identity().ini.str()),
                    {}, "end it, or choose another name in MILLWRIGHT_INSTANCE");
    }
    if (settings_.displayed && !loaded_.machine.display.empty()) {
        auto display = DisplayProgram::words(loaded_.machine.display, whole_path(settings_.ini),
                                             settings_.display_words);
        if (!display.has_value()) {
            return std::unexpected(display.error());
        }
        display_words_ = std::move(*display);
    }
    return {};
}

Result<> MachineStart::make() {
    settings_.options.isLasting = true;
    loaded_.machine.task.confinement.program_folders.push_back(screen::filtered_folder(instance_));
    auto made = machine::make_realtime_machine({loaded_.ini, loaded_.reader, loaded_.machine, sink_},
                                               settings_.options);
    if (!made.has_value()) {
        return std::unexpected(made.error());
    }
    machine_ = std::move(*made);
    access_.emplace(*machine_);
    certifier_.emplace(*machine_, loaded_.machine);
    tell_messages();
    make_parameter_file();
    check_places();
    fmt::print("{} is running: instance '{}', {}\n", loaded_.machine.name, instance_, settings_.ini);
    std::fflush(stdout);
    const auto delay_ns = to_ns(loaded_.machine.applications_delay_s);
    const std::string ini = whole_path(settings_.ini);
    side_programs_.emplace(settings_.displayed ? loaded_.machine.applications : std::vector<std::string>{},
                           ini, access_->now_ns() + delay_ns);
    if (display_words_.empty()) {
        return {};
    }
    auto display = DisplayProgram::start(display_words_, ini);
    if (!display.has_value()) {
        static_cast<void>(take_down());
        return std::unexpected(display.error());
    }
    display_.emplace(std::move(*display));
    return {};
}

/// Creates the file before the screens start, because they read it directly.
void MachineStart::make_parameter_file() {
    const std::string &path = loaded_.machine.task.parameter_file;
    std::error_code ignored;
    if (path.empty() || std::filesystem::exists(path, ignored)) {
        return;
    }
    if (const auto saved = machine_->task().save_parameters(); !saved.has_value()) {
        sink_.warning(saved.error().str());
    }
}

/// Reports files that cannot be saved. Checked at the start, before data can be lost.
void MachineStart::check_places() {
    const machine::MachineConfig &machine = loaded_.machine;
    for (const std::string &file :
         {machine.task.parameter_file, machine.tool_table_file, machine.journal_file}) {
        const std::string folder = std::filesystem::path(file).parent_path().string();
        if (file.empty() || ::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) {
            continue;
        }
        const std::string text =
            fmt::format("changes of {} are not saved: its folder cannot be written", file);
        sink_.warning(text);
        machine_->task().post(messages::MessageKind::OPERATOR_ERROR, text);
    }
}

Result<> MachineStart::keep_up() {
    while (stop_signal == 0) {
        if (auto status = cycle(); !status.has_value()) {
            return status;
        }
        side_programs_->step(access_->now_ns(), sink_);
        display_status_ = display_.has_value() ? display_->end() : std::nullopt;
        if (display_status_.has_value()) {
            if (*display_status_ != 0) {
                sink_.note(fmt::format("the display ended with status {}", *display_status_));
            }
            return {};
        }
    }
    sink_.note("stopped by " + stop_signal_name());
    return {};
}

Result<> MachineStart::cycle() {
    access_->cycle();
    certifier_->step();
    tell_certificates();
    tell_messages();
    return access_->health();
}

/// Called on every exit: stops spindles and axes first, and ends the programs last.
Result<> MachineStart::take_down() {
    const bool healthy = access_->health().has_value();
    if (healthy) {
        switch_off(*access_);
        tell_messages();
    }
    const auto saved = machine_->task().save_parameters();
    end_programs();
    if (healthy) {
        run_shutdown_file();
    }
    tell_certificates();
    certifier_.reset();
    access_.reset();
    machine_.reset();
    return saved;
}

void MachineStart::end_programs() {
    if (display_.has_value()) {
        display_->ask_to_end();
    }
    if (side_programs_.has_value()) {
        side_programs_->ask_to_end();
    }
    const auto haveEnded = [this] {
        return (!display_.has_value() || display_->end().has_value()) &&
               (!side_programs_.has_value() || side_programs_->haveEnded());
    };
    const std::int64_t deadline_ns = access_->now_ns() + END_NS;
    while (!haveEnded() && access_->now_ns() < deadline_ns) {
        access_->cycle();  // answers requests of programs that are ending
    }
    if (display_.has_value()) {
        display_->kill();
    }
    side_programs_.reset();
}

/// Uses halcmd, because the HAL belongs to the realtime process; task continues in this time.
void MachineStart::run_shutdown_file() {
    const std::string &file = loaded_.machine.shutdown_file;
    if (file.empty()) {
        return;
    }
    const std::string ini = whole_path(settings_.ini);
    auto run = DisplayProgram::start({program_folder() + "/halcmd", "-i", ini, "-f", file}, ini);
    if (!run.has_value()) {
        sink_.error("[HAL]SHUTDOWN = " + file + ": " + run.error().str());
        return;
    }
    const std::int64_t deadline_ns = access_->now_ns() + END_NS;
    while (!run->end().has_value() && access_->now_ns() < deadline_ns) {
        access_->cycle();
    }
    if (run->end().value_or(1) != 0) {
        sink_.error(run->end().has_value() ? "[HAL]SHUTDOWN = " + file + " has failed"
                                           : "[HAL]SHUTDOWN = " + file + " did not end in time");
    }
}

/// Reports faults to operators, and each result on the terminal.
void MachineStart::tell_certificates() {
    while (auto finding = certifier_->take_finding()) {
        const std::string file = machine::last_certificate_file(loaded_.machine);
        if (!finding->json.empty() && !file.empty()) {
            machine_->journal()->keep_file(file, std::move(finding->json));
        }
        if (finding->isFault) {
            machine_->task().post(messages::MessageKind::OPERATOR_ERROR, finding->text);
        } else {
            fmt::print(stderr, "{}\n", printable(finding->text));
        }
    }
}

void MachineStart::tell_messages() {
    if (const std::string loss = OutputRelay::take_loss(); !loss.empty() && !loss_reported_) {
        loss_reported_ = true;
        machine_->task().post(messages::MessageKind::OPERATOR_TEXT, loss);
    }
    using Reading = client::Viewer::Reading;
    while (const auto message = machine_->client().next_message(Reading::LOOKS_ON)) {
        // The text of (print,...) is the program's output, which scripts read.
        const bool is_output = message->kind == messages::MessageKind::OPERATOR_TEXT;
        fmt::print(is_output ? stdout : stderr, "{}\n", printable(client::shown_message(*message)));
        std::fflush(stdout);
    }
}

}  // namespace mw::programs
