// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/commission/commissioner.hh"

#include <filesystem>

#include "machine/setup/files.hh"
#include "programs/setup/changed_machine.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;

/// The first error of a machine that did not start.
Error first_error(const diagnostics::Sink &sink, const std::string &ini) {
    for (const diagnostics::Diagnostic &one : sink.all()) {
        if (one.severity == diagnostics::Severity::ERROR) {
            return one.what;
        }
    }
    return Error{"the machine of '" + ini + "' cannot be started", {}, {}, false};
}

}  // namespace

Result<std::unique_ptr<Commissioner>> Commissioner::open(CommissionSetup setup) {
    auto answers = recorded_answers(setup.folder);
    if (!answers.has_value()) {
        return std::unexpected(answers.error());
    }
    const setup::Planned planned = setup::plan_of(*answers);
    if (!planned.faults.empty()) {
        return fail(planned.faults[0].key + ": " + planned.faults[0].text);
    }
    if (!planned.plan.hasBoard()) {
        return fail("the motors of this machine are simulated: there is nothing to check", {},
                    "drives=stepper or drives=servo describes a machine with hardware");
    }
    std::unique_ptr<Commissioner> made(new Commissioner(std::move(setup)));
    made->guide_ = std::make_unique<commissioning::Guide>(std::move(*answers), std::move(made->setup_.known),
                                                          made->setup_.isWanted);
    if (auto started = made->start(); !started.has_value()) {
        return std::unexpected(started.error());
    }
    return made;
}

Commissioner::~Commissioner() {
    stop();
    end_machine();
}

void Commissioner::stop() {
    guide_->stop();
    // Waits until the outputs are off, too, because a port keeps its last written value.
    constexpr int LONGEST = 1000, OUTPUTS = 10;
    int off = 0;
    for (int cycle = 0; machine_ != nullptr && cycle < LONGEST && off < OUTPUTS && machine_->health();
         ++cycle) {
        machine_->cycle();
        bench_->update();
        off = machine_->client().status().trajectory.isEnabled ? 0 : off + 1;
    }
}

void Commissioner::end_machine() {
    guide_->attach(nullptr);
    wrapped_.reset();
    bench_.reset();
    machine_.reset();
    loaded_.reset();
}

Result<> Commissioner::start() {
    std::string ini = (fs::path(setup_.folder) / setup::INI_FILE).string();
    if (setup_.prepare) {
        auto prepared = setup_.prepare(ini);
        if (!prepared.has_value()) {
            return std::unexpected(prepared.error());
        }
        ini = std::move(*prepared);
    }
    loaded_ = machine::LoadedConfig::load(ini, sink_);
    if (loaded_ == nullptr) {
        return std::unexpected(first_error(sink_, ini));
    }
    for (const std::string &command : commissioning::watchdog_commands()) {
        loaded_->machine.hal_steps.push_back(
            {machine::HalStep::Kind::COMMAND, command, {"commissioning", 0, 0}});
    }
    const machine::MachineParts parts{loaded_->ini, loaded_->reader, loaded_->machine, sink_};
    machine::MachineOptions options;
    options.isLasting = true;
    auto made = setup_.clock_virtual ? machine::make_virtual_machine(parts, options)
                                     : machine::make_realtime_machine(parts, options);
    if (!made.has_value()) {
        return std::unexpected(made.error().isTold ? first_error(sink_, ini) : made.error());
    }
    machine_ = std::move(*made);
    bench_ = std::make_unique<commissioning::LiveBench>(machine_->client(), machine_->hal(),
                                                        loaded_->machine.num_joints);
    wrapped_ = setup_.wrap ? setup_.wrap(*bench_) : nullptr;
    if (setup_.on_start) {
        setup_.on_start(*machine_);
    }
    bench_->update();
    guide_->attach(wrapped_ ? wrapped_.get() : bench_.get());
    return {};
}

Result<> Commissioner::restart() {
    end_machine();
    const setup::Planned planned = setup::plan_of(guide_->answers());
    const auto change = change_machine(setup_.folder, planned.plan, guide_->answers(), ConflictRule::REPORT);
    if (!change.has_value()) {
        return std::unexpected(change.error());
    }
    if (!change->isWritten) {
        return fail("edited lines of the machine's files conflict with what was measured:\n" +
                        change_text(*change),
                    {}, "`millwright commission write` shows and resolves conflicts");
    }
    return start();
}

Result<> Commissioner::cycle() {
    machine_->cycle();
    if (auto health = machine_->health(); !health.has_value()) {
        return health;
    }
    bench_->update();
    guide_->cycle();
    return guide_->isRestartWanted() ? restart() : Result<>{};
}

}  // namespace mw::programs
