// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/bench.hh"

#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace mw::task_campaign {
namespace {

namespace files = std::filesystem;

constexpr const char *HAL = "loadrt [KINS]KINEMATICS\n"
                            "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=3\n"
                            "addf motion-command-handler servo-thread\naddf motion-controller servo-thread\n"
                            "newsig chain bit\nnet chain => iocontrol.0.emc-enable-in\n";

std::string ini_of(const Plan &plan) {
    std::string out = fmt::format(
        "[EMC]\nVERSION = 1.1\n[DISPLAY]\nMAX_FEED_OVERRIDE = 2\n[TASK]\nCYCLE_TIME = 0.001\n"
        "[RS274NGC]\nPARAMETER_FILE = sim.var\n[EMCMOT]\nEMCMOT = motmod\nSERVO_PERIOD = 1000000\n"
        "[EMCIO]\nTOOL_TABLE = sim.tbl\nRANDOM_TOOLCHANGER = {}\n[HAL]\nHALFILE = sim.hal\n"
        "[TRAJ]\nCOORDINATES = X Y Z\nLINEAR_UNITS = mm\nANGULAR_UNITS = degree\nMAX_LINEAR_VELOCITY = 2000\n"
        "MAX_LINEAR_ACCELERATION = 20000\n[KINS]\nKINEMATICS = trivkins coordinates=XYZ\nJOINTS = 3\n",
        plan.isRandomChanger ? 1 : 0);
    for (int j = 0; j < AXES; ++j) {
        const std::string limits =
            fmt::format("MAX_VELOCITY = 2000\nMAX_ACCELERATION = 20000\nMIN_LIMIT = {}\nMAX_LIMIT = {}\n",
                        -LIMIT_MM, LIMIT_MM);
        out += fmt::format("[JOINT_{}]\nTYPE = LINEAR\nFERROR = 10\nMIN_FERROR = 10\nHOME = 0\n"
                           "HOME_OFFSET = 0\nHOME_SEQUENCE = 0\n{}[AXIS_{}]\n{}",
                           j, limits, "XYZ"[j], limits);
    }
    return out;
}

std::string table_of(const std::vector<Tool> &tools) {
    std::string out;
    for (const Tool &tool : tools) {
        out += fmt::format("T{} P{} Z{:.4f} ;tool {}\n", tool.number, tool.pocket, tool.z, tool.number);
    }
    return out;
}

}  // namespace

Bench::Bench(const Plan &plan, files::path folder)
    : plan_(plan), folder_(std::move(folder)), random_(plan.seed) {
    write_files();
    changer.answer_ms = plan.changer_ms;
}

Bench::~Bench() {
    if (isUp()) {
        die(false);
    }
}

void Bench::write_files() const {
    std::ofstream(folder_ / "sim.ini") << ini_of(plan_);
    std::string hal = HAL;
    for (int j = 0; j < AXES; ++j) {
        hal += fmt::format("net pos-{0} joint.{0}.motor-pos-cmd => joint.{0}.motor-pos-fb\n", j);
    }
    std::ofstream(folder_ / "sim.hal") << hal;
    std::ofstream(folder_ / "sim.tbl") << table_of(plan_.tools);
    std::ofstream(folder_ / "sim.var") << "3101 0\n";
}

std::string Bench::come_up() {
    const std::string var = folder_ / "sim.var";
    if (disk_.names.contains(var)) {
        std::ofstream(var) << disk_.files[disk_.names[var]].now;
    }
    loaded_ = machine::LoadedConfig::load(folder_ / "sim.ini", sink_);
    const auto told = [this](std::string text) {
        for (const auto &one : sink_.all()) {
            text += "; " + one.str();
        }
        return text;
    };
    if (loaded_ == nullptr) {
        return told("the INI file has errors");
    }
    writer_ = std::make_unique<journal::Writer>(std::make_unique<journal::test::TornDiskView>(disk_),
                                                "journal", journal::Works::ON_CALL);
    machine::MachineOptions options;
    options.journal = writer_.get();
    auto made =
        machine::make_virtual_machine({loaded_->ini, loaded_->reader, loaded_->machine, sink_}, options);
    if (!made.has_value()) {
        return told(made.error().str());
    }
    machine_ = std::move(*made);
    programs_ended_ = 0;
    for (std::size_t i = 0; i < clients_.size(); ++i) {
        const std::string trouble = join(i);
        if (!trouble.empty()) {
            return trouble;
        }
    }
    if (!disk_.names.contains(var)) {  // the disk has all parameters from the start
        static_cast<void>(machine_->task().save_parameters());
    }
    return bind();
}

std::string Bench::join(std::size_t number) {
    auto client = client::Client::join(machine_->mailbox());
    if (!client.has_value()) {
        return client.error().str();
    }
    clients_[number] = std::make_unique<client::Client>(std::move(*client));
    return "";
}

std::string Bench::bind() {
    std::string missing;
    const auto find = [&](const char *name, hal::Type type) -> volatile void * {
        const auto address = machine_->hal().values().address_of(name, type);
        missing = address ? missing : name;
        return address ? *address : nullptr;
    };
    const auto bit = [&](const char *name) {
        return static_cast<volatile bool *>(find(name, hal::Type::BIT));
    };
    pins_ = {bit("chain"),
             bit("joint.0.amp-enable-out"),
             bit("spindle.0.on"),
             bit("iocontrol.0.coolant-mist"),
             bit("iocontrol.0.coolant-flood"),
             bit("iocontrol.0.tool-prepare"),
             bit("iocontrol.0.tool-change"),
             bit("motion.in-position"),
             bit("iocontrol.0.tool-prepared"),
             bit("iocontrol.0.tool-changed"),
             bit("iocontrol.0.toolchanger-fault"),
             bit("spindle.0.at-speed"),
             static_cast<volatile double *>(find("spindle.0.speed-out", hal::Type::FLOAT)),
             static_cast<volatile std::int32_t *>(find("iocontrol.0.tool-number", hal::Type::S32))};
    if (missing.empty()) {
        *pins_.chain = true;
        *pins_.at_speed = true;
    }
    return missing.empty() ? "" : "no pin " + missing;
}

void Bench::die(bool isPowerCut) {
    disk_.isDead = true;
    for (auto &client : clients_) {
        client.reset();
    }
    machine_.reset();
    writer_.reset();
    loaded_.reset();
    disk_.isDead = false;
    if (isPowerCut) {
        disk_.cut_power(random_);
    }
}

void Bench::lose_client(int number) {
    constexpr std::uint64_t NOBODY = 0x3fffff;  // a number that no process has
    constexpr int START_BITS = 42;
    auto &client = clients_[static_cast<std::size_t>(number)];
    for (mailbox::Slot &slot : machine_->mailbox().slots) {
        if (slot.owner.load() != 0 && slot.client.load() == client->id()) {
            slot.owner.store(NOBODY << START_BITS | 1U);
        }
    }
    static_cast<void>(client.release());  // leaked: a killed client does not log off
    static_cast<void>(join(static_cast<std::size_t>(number)));
}

void Bench::cycle() {
    step_changer();
    machine_->cycle();
    ++now_ms_;
    // As `millwright start` does.
    if (status().task.programs_ended != programs_ended_) {
        programs_ended_ = status().task.programs_ended;
        static_cast<void>(machine_->task().save_parameters());
    }
    step_disk();
}

void Bench::step_changer() {
    const bool isAsked = *pins_.tool_prepare || *pins_.tool_change;
    asked_ms_ = isAsked ? asked_ms_ + 1 : 0;
    const bool isAnswer = isAsked && asked_ms_ > changer.answer_ms;
    *pins_.fault = isAnswer && changer.isFaulted;
    *pins_.tool_prepared = isAnswer && !changer.isFaulted && *pins_.tool_prepare;
    *pins_.tool_changed = isAnswer && !changer.isFaulted && *pins_.tool_change;
    if (*pins_.fault) {
        changer.isFaulted = false;
    }
}

/// Maximum delay of the writer's thread.
void Bench::step_disk() {
    if (--late_ms_ <= 0) {
        late_ms_ = static_cast<int>(random_() % MOST_LATE_MS);
        writer_->work();
    }
}

std::map<int, double> Bench::parameters() const {
    std::map<int, double> all;
    const auto name = disk_.names.find(folder_ / "sim.var");
    if (name == disk_.names.end()) {
        return all;
    }
    std::istringstream lines(disk_.files.at(name->second).now);
    int number = 0;
    for (double value = 0; lines >> number >> value;) {
        all[number] = value;
    }
    return all;
}

std::string Bench::tool_table() const {
    std::ostringstream text;
    text << std::ifstream(folder_ / "sim.tbl").rdbuf();
    return text.str();
}

void Bench::write_tool_table(const std::vector<Tool> &tools) const {
    std::ofstream(folder_ / "sim.tbl") << table_of(tools);
}

std::string Bench::write_program(const std::string &text) {
    const files::path path = folder_ / "p.ngc";
    std::ofstream(path) << text;
    disk_.write_outside(path, text);
    return path;
}

}  // namespace mw::task_campaign
