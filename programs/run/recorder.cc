// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/recorder.hh"

#include <fmt/format.h>

#include "machine/task/task.hh"

namespace mw::programs {

Recorder::Recorder(machine::Machine &machine, const machine::MachineConfig &config)
    : machine_(machine), monitor_(config.servo_period_ns),
      certificate_(machine::certificate_settings(config)) {
    machine_.task().set_move_listener([this](const task::SentMove &move) {
        monitor_.on_move(move.start, move.body);
        certificate_.on_move(move);
    });
}

Result<> Recorder::open_trace(const std::string &path, const machine::MachineConfig &config) {
    auto writer = TraceWriter::create(path, config.axis_mask, config.num_joints);
    if (!writer.has_value()) {
        return std::unexpected(writer.error());
    }
    trace_.emplace(std::move(*writer));
    return {};
}

void Recorder::start() {
    started_ = true;
    monitor_.start(machine_.task().motion_status().carte_pos_cmd);
    machine_.channels().isTracing.store(1);
}

void Recorder::drain() {
    motion::TraceSample sample;
    while (machine_.channels().trace.pop(sample)) {
        certificate_.on_sample(sample);
        monitor_.on_sample(sample, certificate_.isRapid());
        if (trace_.has_value()) {
            trace_->write(sample);
        }
    }
}

Result<> Recorder::finish(machine::ProgramEnd end) {
    drain();
    certificate_.finish(end);
    machine_.channels().isTracing.store(0);
    machine_.task().set_move_listener({});
    const std::uint64_t lost = machine_.channels().trace_lost.load();
    const auto closed = trace_.has_value() ? trace_->close() : Result<>{};
    if (closed.has_value() && trace_.has_value() && lost > 0) {
        return fail(
            fmt::format("the trace lacks {} servo cycles: this process was too slow to write them", lost));
    }
    return closed;
}

}  // namespace mw::programs
