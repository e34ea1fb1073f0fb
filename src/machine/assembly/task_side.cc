// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/assembly/task_side.hh"

#include "base/text.hh"
#include "base/whole_path.hh"
#include "machine/assembly/hal_setup.hh"

namespace mw::machine {
namespace {

constexpr const char *ESTOP_PIN = "iocontrol.0.emc-enable-in";
constexpr const char *MOTION_ESTOP_PIN = "motion.emc-enable-in";

halui::HaluiSettings halui_settings(const MachineConfig &config) {
    constexpr double MM_PER_INCH = 25.4;
    halui::HaluiSettings settings;
    settings.num_joints = config.num_joints;
    settings.num_spindles = config.num_spindles;
    settings.axis_mask = config.axis_mask;
    settings.units_per_mm = config.metric ? 1.0 : 1.0 / MM_PER_INCH;
    settings.max_feed_override = config.panel.max_feed_override;
    settings.spindle_override = {config.panel.min_spindle_override, config.panel.max_spindle_override};
    settings.max_velocity = config.panel.max_velocity;
    settings.mdi_commands = config.panel.mdi_commands;
    return settings;
}

}  // namespace

TaskSide::TaskSide(const MachineParts &parts, hal::Host &host, mailbox::Memory mailbox,
                   hal::script::ProgramHost *programs)
    : parts_(parts), host_(host), programs_(programs), mailbox_(std::move(mailbox)),
      parameters_(parts.ini, &host.hal()) {}

TaskSide::~TaskSide() {
    task_.reset();
    tool_change_.destroy();
    halui_.destroy();
    ini_pins_.destroy();
    io_pins_.destroy();
}

/// Takes the reserved slots before other clients, because clients that poll for the machine take all slots
/// until task frees them.
Result<> TaskSide::take_places() {
    auto client = client::Client::join(mailbox_.segment());
    if (!client.has_value()) {
        return std::unexpected(client.error());
    }
    client_.emplace(std::move(*client));
    return parts_.config.has_halui ? halui_.join(mailbox_.segment()) : Result<>{};
}

Result<> TaskSide::start(const MachineOptions &options) {
    if (const auto taken = take_places(); !taken.has_value()) {
        return taken;
    }
    diagnostics::Sink unheard;
    if (options.journal == nullptr && !options.clock_virtual) {
        journal_ = std::make_unique<journal::Writer>(journal::system_disk(), parts_.config.journal_file,
                                                     journal::Works::ALONE);
    }
    journal::Writer *const journal = options.journal != nullptr ? options.journal : journal_.get();
    auto tools = open_tools(parts_.config, options.tool_table_reported ? unheard : parts_.sink,
                            {journal, options.clock_virtual});
    if (!tools.has_value()) {
        return std::unexpected(tools.error());
    }
    tools_ = std::move(*tools);
    lasting_ = options.isLasting;
    auto status = make_pins();
    status = status.has_value() ? run_hal_files(options) : status;
    status = status.has_value() ? link_estop_chain() : status;
    status = status.has_value() ? join_motion() : status;
    status = status.has_value() ? host_.hal().threads().start() : status;
    if (!status.has_value()) {
        return status;
    }
    task::Settings settings = parts_.config.task;
    settings.user_program_awaited = options.clock_virtual;
    settings.sequencer.log_works = options.clock_virtual ? task::LogWorks::ON_CALL : task::LogWorks::ALONE;
    task_ = std::make_unique<task::Task>(
        task::Parts{*channels_, *this, *tools_, parameters_, mailbox_.segment(), journal},
        std::move(settings));
    task_->configure(parts_.config.parameters, parts_.config.screw_tables);
    return {};
}

/// From now on clients find the machine ready.
Result<> TaskSide::identify() {
    mailbox::Identity identity;
    if (!identity.ini.assign(whole_path(parts_.ini.path()))) {
        return fail("the path of the INI file is too long", {parts_.ini.path(), 0, 0});
    }
    identity.isLasting = lasting_;
    mailbox_.segment().identity.write(identity);
    return {};
}

Result<> TaskSide::make_pins() {
    auto status = io_pins_.create(host_.hal());
    if (status.has_value()) {
        const auto number = [this](const char *key) {
            const ini::IniEntry *entry = parts_.ini.find("TRAJ", key);
            return entry != nullptr ? parse_double(entry->value).value_or(0) : 0;
        };
        status = ini_pins_.create(host_.hal(), parts_.config.parameters, parts_.config.num_joints,
                                  {number("DEFAULT_LINEAR_VELOCITY"), number("DEFAULT_LINEAR_ACCELERATION")});
    }
    if (status.has_value() && parts_.config.has_halui) {
        status = halui_.create(host_.hal(), halui_settings(parts_.config));
    }
    return status;
}

Result<> TaskSide::run_hal_files(const MachineOptions &options) {
    HalSetup setup(parts_, host_, programs_, options);
    const ToolHand hand = options.clock_virtual ? ToolHand::SIMULATED : ToolHand::PERSON;
    setup.on_tool_change_program = [this, hand] {
        return tool_change_.create(host_.hal(), hand,
                                   [this, hand](const std::string &text) { tell_tool_change(hand, text); });
    };
    auto status = setup.run();
    if (!status.has_value() && options.kept_going) {
        status = {};  // the error is already reported
    }
    if (status.has_value()) {
        parts_.reader.report_unknown(options.strict);
    }
    return status.has_value() && parts_.sink.hasErrors() && !options.kept_going
               ? fail_told("the INI file has errors", {parts_.ini.path(), 0, 0})
               : status;
}

/// Reported to all clients, because a person may be at any of them.
void TaskSide::tell_tool_change(ToolHand hand, const std::string &text) {
    if (hand == ToolHand::PERSON) {
        task_->post(messages::MessageKind::OPERATOR_TEXT, text);
    } else {
        parts_.sink.note(text);
    }
}

Result<> TaskSide::join_motion() {
    const auto block =
        host_.hal().memory().shared_block(motion::Channels::SHMEM_KEY, sizeof(motion::Channels));
    if (!block.has_value()) {
        return std::unexpected(block.error());
    }
    channels_ = static_cast<motion::Channels *>(*block);
    if (channels_->magic != motion::Channels::MAGIC) {
        return fail("no HAL file has loaded the motion controller", {parts_.ini.path(), 0, 0},
                    "expected 'loadrt [EMCMOT]EMCMOT ...' (motmod) in one of the files of [HAL]HALFILE");
    }
    if (channels_->layout_bytes != sizeof(motion::Channels)) {
        return fail("the motion controller that is loaded belongs to another version of Millwright");
    }
    return io_pins_.join_tool_offset();
}

Result<> TaskSide::link_estop_chain() {
    hal::Instance &hal = host_.hal();
    const auto chain = hal.pins().find(ESTOP_PIN);
    const auto motion_pin = hal.pins().find(MOTION_ESTOP_PIN);
    const bool linkable =
        chain.has_value() && !chain->signal.empty() && motion_pin.has_value() && motion_pin->signal.empty();
    if (chain.has_value() && chain->signal.empty()) {
        parts_.sink.warning(std::string("pin ") + ESTOP_PIN +
                                " is not linked: the machine stays in emergency stop",
                            {parts_.ini.path(), 0, 0});
    }
    return linkable ? hal.signals().link(MOTION_ESTOP_PIN, chain->signal) : Result<>{};
}

Result<bool> TaskSide::isConfigured() {
    const auto done = task_->isConfigured();
    return done.has_value() ? done : fail(done.error().message, {parts_.ini.path(), 0, 0});
}

Result<> TaskSide::finish_start(Machine &machine, int most_cycles) {
    constexpr int POINTS_PER_CYCLE = 32;  // minimum number of points
    for (const auto &table : parts_.config.screw_tables) {
        most_cycles += static_cast<int>(table.size()) / POINTS_PER_CYCLE;
    }
    for (int i = 0; i < most_cycles; ++i) {
        machine.cycle();
        if (auto health = machine.health(); !health) {
            return health;
        }
        const auto done = isConfigured();
        if (!done.has_value()) {
            return std::unexpected(done.error());
        }
        if (*done) {
            machine.cycle();
            const auto started = task_->start();
            return started.has_value() ? identify() : started;
        }
    }
    return fail("the motion controller does not run", {parts_.ini.path(), 0, 0},
                "are motion-command-handler and motion-controller added to a thread (addf)?");
}

void TaskSide::step(std::int64_t now_ns) {
    ini_pins_.step(*task_);
    task_->step(now_ns);
    step_hands(now_ns);
}

void TaskSide::step_apart(std::int64_t now_ns) {
    task_->step_apart(now_ns);
    step_hands(now_ns);
}

void TaskSide::step_hands(std::int64_t now_ns) {
    tool_change_.step(now_ns);
    if (parts_.config.has_halui) {
        halui_.step();
    }
}

}  // namespace mw::machine
