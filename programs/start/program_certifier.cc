// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/start/program_certifier.hh"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "base/overloaded.hh"
#include "machine/task/task.hh"

namespace mw::programs {
namespace {

/// Sleep of the thread; the ring has space for seconds of samples.
constexpr std::chrono::milliseconds READ_INTERVAL{50};

std::optional<std::uint32_t> file_of(const motion::PathBody &body) {
    return std::visit(
        [](const auto &move) -> std::optional<std::uint32_t> {
            if constexpr (requires { move.terms; }) {
                return move.terms.source.file_index;
            } else {
                return std::nullopt;
            }
        },
        body);
}

}  // namespace

ProgramCertifier::ProgramCertifier(machine::Machine &machine, const machine::MachineConfig &config)
    : machine_(machine), config_(config), file_(machine::last_certificate_file(config)) {
    machine_.task().set_move_listener(
        [this](const task::SentMove &move) { sent_.push_back({move.id, move.start, move.body}); });
    thread_ = std::jthread([this](const std::stop_token &stop) { run(stop); });
}

ProgramCertifier::~ProgramCertifier() {
    machine_.task().set_move_listener({});
    machine_.channels().isTracing.store(0);
}

void ProgramCertifier::push(Event event) {
    const std::lock_guard lock(mutex_);
    events_.push_back(std::move(event));
}

/// Passes the names of files, because the thread cannot ask task for them.
void ProgramCertifier::pass_file_name(const motion::PathBody &body) {
    const std::optional<std::uint32_t> index = file_of(body);
    if (index.has_value() && std::ranges::find(passed_files_, *index) == passed_files_.end()) {
        passed_files_.push_back(*index);
        push(FileName{*index, machine_.task().file_name(*index)});
    }
}

void ProgramCertifier::step() {
    const task::Status &status = machine_.task().status();
    const bool isBusy = status.task.interp_state != messages::InterpState::IDLE;
    // A paused program remains active in other modes.
    const bool isAuto = status.task.mode == messages::Mode::AUTO;
    const bool wasRunning = std::exchange(isRunning_, isBusy && (isRunning_ || isAuto));
    machine_.channels().isTracing.store(isRunning_ || isAuto ? 1 : 0);
    if (isRunning_ && !wasRunning) {
        start_ns_ = machine_.now_ns();
        passed_files_.clear();
        push(Begin{status.task.program.str()});
    }
    if (isRunning_ || wasRunning) {
        pass_moves();
    }
    sent_.clear();
    if (wasRunning && !isRunning_) {
        push(
            End{machine_.task().run().isDone() ? machine::ProgramEnd::COMPLETE : machine::ProgramEnd::STOPPED,
                static_cast<double>(machine_.now_ns() - start_ns_) * 1e-9});
    }
}

/// Passes the moves of this cycle. The first moves of a program are sent in the cycle in which it begins.
void ProgramCertifier::pass_moves() {
    for (Move &move : sent_) {
        pass_file_name(move.body);
        push(std::move(move));
    }
}

std::optional<ProgramCertifier::Finding> ProgramCertifier::take_finding() {
    const std::lock_guard lock(mutex_);
    if (findings_.empty()) {
        return std::nullopt;
    }
    Finding finding = std::move(findings_.front());
    findings_.pop_front();
    return finding;
}

void ProgramCertifier::add(Finding finding) {
    const std::lock_guard lock(mutex_);
    findings_.push_back(std::move(finding));
}

void ProgramCertifier::run(const std::stop_token &stop) {
    while (!stop.stop_requested()) {
        std::deque<Event> events;
        {
            std::unique_lock lock(mutex_);
            wake_.wait_for(lock, stop, READ_INTERVAL, [] { return false; });
        }
        // Reads the samples first: a move is passed on when it is sent, so the samples that execute it are
        // read later.
        read_samples();
        {
            const std::lock_guard lock(mutex_);
            events.swap(events_);
        }
        for (Event &event : events) {
            take(event);
        }
        take_samples();
    }
}

void ProgramCertifier::take(Event &event) {
    std::visit(Overloaded{
                   [this](Begin &begin) {
                       files_.clear();
                       program_.emplace(
                           Program{std::move(begin.program),
                                   machine::MotionCertificate(machine::certificate_settings(config_))});
                   },
                   [this](const Move &move) {
                       if (program_.has_value()) {
                           program_->certificate.on_move({move.id, move.start, move.body});
                       }
                   },
                   [this](FileName &file) { files_[file.index] = std::move(file.name); },
                   [this](const End &end) {
                       read_samples();
                       take_samples();
                       finish(end);
                   },
               },
               event);
}

void ProgramCertifier::read_samples() {
    motion::TraceSample sample;
    while (machine_.channels().trace.pop(sample)) {
        samples_.push_back(sample);
    }
}

/// Samples between programs are dropped.
void ProgramCertifier::take_samples() {
    for (const motion::TraceSample &sample : samples_) {
        if (program_.has_value()) {
            program_->certificate.on_sample(sample);
        }
    }
    samples_.clear();
}

void ProgramCertifier::finish(const End &end) {
    if (!program_.has_value()) {
        return;
    }
    program_->certificate.finish(end.how);
    const CertificateReport report{
        .program = program_->name,
        .machine = config_,
        .certificate = program_->certificate.result(),
        .cycle_time_s = end.cycle_time_s,
        .wasFinished = end.how == machine::ProgramEnd::COMPLETE,
        .was_realtime = !machine_.isVirtual(),
        .file_name = [this](std::uint32_t index) { return files_[index]; },
    };
    program_.reset();
    const machine::Certificate &found = report.certificate;
    if (!found.isWithinLimits() || !found.isWithinTolerance()) {
        add({fmt::format(
                 "The commanded motion of {} exceeded a limit or a tolerance. The certificate has line and "
                 "value: {}",
                 report.program, file_),
             true,
             {}});
    }
    add({certificate_line(report), false, certificate_json(report)});
}

}  // namespace mw::programs
