// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/run_journal.hh"

namespace mw::task {

void prepare_journal(const RunParts &parts) {
    if (!parts.recovery.isOn() || !parts.run.isProgram()) {
        return;
    }
    StartRecord record;
    record.confined = parts.senders.isRunConfined();
    record.machine = parts.world.snapshot();
    record.isBlockDelete = parts.world.isBlockDeleteOn();
    record.isOptionalStop = parts.world.isOptionalStopOn();
    for (int i = 0; i < parts.tools.count(); ++i) {
        record.tools.push_back(parts.tools.entry(i));
    }
    record.add_spindles(parts.sequencer.spindles().starts());
    const motion::Status &motion = parts.port.motion();
    record.digital_out = motion.digital_out;
    record.analog_out.assign(motion.analog_out.begin(), motion.analog_out.end());
    const auto kept = parts.reader.keep_start(record);
    parts.reader.begin_marks();
    parts.recovery.prepare(parts.run.program().str(), record, kept.has_value() ? "" : kept.error().message);
}

void begin_journal(const RunParts &parts, std::uint32_t first_block) {
    const std::string dropped = parts.recovery.begin(first_block);
    if (!dropped.empty()) {
        parts.port.post(MessageKind::OPERATOR_TEXT, dropped);
    }
}

void journal_doubt(const RunParts &parts) {
    const std::string doubt =
        parts.recovery.isOn() && parts.run.isProgram() ? parts.reader.take_doubt() : std::string();
    if (!doubt.empty()) {
        parts.recovery.note_doubt(parts.reader.canon().blocks(), parts.reader.main_line(), doubt);
    }
}

void show_journal(const RunParts &parts, RecoveryStatus &status) {
    while (const auto trouble = parts.recovery.take_trouble()) {
        parts.port.post_error(*trouble);
    }
    parts.recovery.show(status);
}

void journal_place(const RunParts &parts) {
    const ProgramRun &run = parts.run;
    const bool active = run.isProgram() && run.phase() >= RunPhase::READING && run.hold() != Hold::PROPOSED;
    if (active && parts.recovery.isOn()) {
        const motion::SourceTag source = parts.sequencer.place().source;
        const geometry::Pose place = motion::programmed_position(parts.port.motion());
        parts.recovery.step(parts.port.now_ns(),
                            {source.block, source.line, place, parts.io.outputs.tool_number},
                            parts.reader.canon().marks(), parts.tools);
    }
}

}  // namespace mw::task
