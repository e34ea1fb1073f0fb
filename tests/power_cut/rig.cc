// SPDX-License-Identifier: GPL-2.0-or-later
#include "power_cut/rig.hh"

#include <fstream>

#include <fmt/format.h>

#include "programs/run/run_session.hh"

namespace mw::power_cut {
namespace {

namespace files = std::filesystem;

std::string bits(const geometry::Pose &pose) {
    std::string text;
    for (const double coordinate : pose.c) {
        text += fmt::format(" {:a}", coordinate);
    }
    return text;
}

std::string bits(const motion::MoveTerms &t) {
    return fmt::format(" {} {} {} {} {:a} {:a} {:a} {:a}", t.isRapid, static_cast<int>(t.mode),
                       static_cast<int>(t.synch_spindle), t.velocity_synched, t.feed, t.tolerance,
                       t.naivecam_tolerance, t.feed_per_revolution);
}

struct Told {
    std::uint32_t block = 0;
    std::string text;
};

Told told(const motion::Line &move) {
    return {move.terms.source.block, "line" + bits(move.end) + bits(move.terms)};
}
Told told(const motion::Arc &move) {
    return {move.terms.source.block, "arc" + bits(move.end) + bits(move.centre) + bits(move.normal) +
                                         fmt::format(" {:a}", move.angle_rad) + bits(move.terms)};
}
Told told(const motion::Probe &move) {
    return {move.terms.source.block, "probe" + bits(move.end)};
}
Told told(const motion::RigidTap &move) {
    return {move.terms.source.block, "tap" + bits(move.end) + bits(move.terms)};
}
template <class Other>
Told told(const Other &) {
    return {0, "other"};
}

}  // namespace

Rig::Rig(files::path folder, journal::test::TornDisk &disk) : folder_(std::move(folder)), disk_(disk) {
    files::create_directories(folder_);
    files::copy_file(MW_SOURCE_DIR "/configs/sim/mill_mm.tbl", folder_ / "tools.tbl",
                     files::copy_options::overwrite_existing);
}

Rig::~Rig() {
    die();
}

void Rig::die() {
    machine_.reset();
    writer_.reset();
    loaded_.reset();
}

std::string Rig::come_up(const std::vector<std::string> &mdi) {
    steps_in_write = -1;
    loaded_ = machine::LoadedConfig::load(MW_SOURCE_DIR "/configs/sim/mill_mm.ini", sink_);
    if (loaded_ == nullptr) {
        return "the INI file cannot be read";
    }
    loaded_->machine.task.parameter_file = folder_ / "p.var";
    find_parameters();
    loaded_->machine.tool_table_file = folder_ / "tools.tbl";
    writer_ = std::make_unique<journal::Writer>(std::make_unique<journal::test::TornDiskView>(disk_),
                                                "journal", journal::Works::ON_CALL);
    machine::MachineOptions options;
    options.journal = writer_.get();
    auto made =
        machine::make_virtual_machine({loaded_->ini, loaded_->reader, loaded_->machine, sink_}, options);
    if (!made.has_value()) {
        return made.error().str();
    }
    machine_ = std::move(*made);
    programs::OwnMachine own(*machine_);
    programs::RunSession person(own, loaded_->machine, sink_, {});
    auto up = person.switch_on();
    up = up.has_value() ? person.home_all() : up;
    if (!up.has_value()) {
        return up.error().str();
    }
    for (const std::string &line : mdi) {
        auto trouble = ask(messages::SetMode{messages::Mode::MDI});
        trouble = trouble.empty() ? ask(messages::Mdi{line}) : trouble;
        if (!trouble.empty()) {
            return line + ": " + trouble;
        }
    }
    listen();
    return ask(messages::SetMode{messages::Mode::AUTO});
}

/// The interpreter reads a real file, with the contents of the disk.
void Rig::find_parameters() {
    files::remove(folder_ / "p.var");
    if (disk_.names.contains(folder_ / "p.var")) {
        std::ofstream(folder_ / "p.var") << disk_.files[disk_.names[folder_ / "p.var"]].now;
    }
}

void Rig::listen() {
    recording = {};
    told_ = 0;
    machine_->task().set_move_listener([this](const task::SentMove &move) {
        const Told one = std::visit([](const auto &body) { return told(body); }, move.body);
        recording.calls.push_back({move.id, one.block, one.text});
    });
}

void Rig::tell_what_is_on() {
    const messages::MachineStatus &now = status();
    const motion::CommandId under_way = machine_->task().motion_status().active_path_id;
    while (told_ < recording.calls.size() && recording.calls[told_].id <= under_way) {
        recording.calls[told_++].bits +=
            fmt::format(" on {} {} {} tool {}", now.spindles[0].direction, now.io.coolant.isFloodOn,
                        now.io.coolant.isMistOn, now.tool.in_spindle);
    }
}

std::string Rig::ask(const messages::Command &command, int limit) {
    const auto posted = machine_->client().post(command);
    if (!posted.has_value()) {
        return posted.error().str();
    }
    for (int i = 0; i < limit; ++i) {
        machine_->cycle();
        const auto outcome = machine_->client().outcome(*posted);
        if (outcome.progress != messages::Progress::STARTED) {
            return outcome.progress == messages::Progress::DONE ? "" : outcome.reason + " ";
        }
    }
    return "it does not end";
}

std::string Rig::begin(const std::string &program, int from_line) {
    const files::path path = folder_ / "p.ngc";
    std::ofstream(path) << program;
    disk_.write_outside(path, program);
    const auto opened = ask(messages::OpenProgram{path});
    const auto posted = machine_->client().post(messages::RunProgram{from_line});
    run_ = posted.value_or(0);
    return opened;
}

void Rig::cycle(std::mt19937_64 &random) {
    machine_->cycle();
    tell_what_is_on();
    const motion::Status &motion = machine_->task().motion_status();
    recording.under_tool.push_back(motion.active_path_id != 0 ? motion.source.block : 0);
    late_ms_ =
        late_ms_ < 0 ? static_cast<int>(random() % static_cast<unsigned>(most_late_ms + 1)) : late_ms_ - 1;
    if (late_ms_ < 0 || steps_in_write >= 0) {
        disk_.steps_left = steps_in_write;
        writer_->work();
    }
    if (hasEnded() && !recording.isDone) {
        recording.isDone = machine_->client().outcome(run_).progress == messages::Progress::DONE;
        static_cast<void>(machine_->task().save_parameters());
        recording.parameters = disk_.files[disk_.names[folder_ / "p.var"]].now;
    }
}

bool Rig::hasEnded() const {
    return machine_->client().outcome(run_).progress != messages::Progress::STARTED;
}

std::string Rig::outcome() {
    return machine_->client().outcome(run_).reason;
}

const messages::MachineStatus &Rig::status() {
    return machine_->task().status();
}

std::string Rig::recover() {
    const auto posted = machine_->client().post(messages::RecoverProgram{});
    if (!posted.has_value()) {
        return posted.error().str();
    }
    run_ = *posted;
    constexpr int LIMIT = 20000;
    for (int i = 0; i < LIMIT && !hasEnded(); ++i) {
        machine_->cycle();
        if (status().approach.number != 0) {
            return ask(messages::ConfirmApproach{status().approach.number});
        }
    }
    return hasEnded() ? outcome() + " " : "nothing is proposed";
}

}  // namespace mw::power_cut
