// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine in virtual time, homed and switched on, for tests.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/core/instance.hh"
#include "machine/assembly/machine.hh"
#include "machine/config/loaded_config.hh"
#include "machine/task/task.hh"
#include "messages/client/client.hh"
#include "motion/interface/channels.hh"
#include "programs/run/run_session.hh"
#include "sim/joint_judge.hh"

namespace mw::machine {

/// The mill configs/sim/mill_mm.ini with a separate folder.
class VirtualMachineTest : public ::testing::Test {
  protected:
    VirtualMachineTest() {
        folder_ = std::filesystem::temp_directory_path() / ("mw_sim_" + std::to_string(::getpid()));
        std::filesystem::create_directory(folder_);
    }
    ~VirtualMachineTest() override {
        EXPECT_EQ(judge_.report(), "") << "joints outside their limits";
        machine_.reset();
        std::filesystem::remove_all(folder_);
    }

    /// Builds the machine with changed settings; parameters are kept in memory.
    void switch_on(const std::function<void(task::Settings &)> &change = {}) {
        switch_on_config(MW_SOURCE_DIR "/configs/sim/mill_mm.ini", change);
    }
    void switch_on_config(const std::string &ini, const std::function<void(task::Settings &)> &change = {}) {
        machine_.reset();
        loaded_ = LoadedConfig::load(ini, sink_);
        ASSERT_NE(loaded_, nullptr) << ini;
        judge_ = JointJudge(loaded_->machine);
        loaded_->machine.task.parameter_file.clear();
        if (change) {
            change(loaded_->machine.task);
        }
        auto made =
            make_virtual_machine({loaded_->ini, loaded_->reader, loaded_->machine, sink_}, MachineOptions{});
        ASSERT_TRUE(made.has_value()) << made.error().str();
        machine_ = std::move(*made);
        programs::OwnMachine own(*machine_);
        programs::RunSession person(own, loaded_->machine, sink_, {});
        ASSERT_TRUE(person.switch_on().has_value());
        ASSERT_TRUE(person.home_all().has_value());
        machine_->channels().isTracing.store(1);
    }
    /// A copy of a file of configs/sim with parts of its text replaced; returns its path.
    std::string changed_config(const std::string &name,
                               const std::vector<std::pair<std::string, std::string>> &changes) {
        std::ostringstream text;
        text << std::ifstream(std::string(MW_SOURCE_DIR "/configs/sim/") + name).rdbuf();
        std::string all = text.str();
        const auto replace_all = [&](const std::string &from, const std::string &to) {
            std::size_t count = 0;
            for (std::size_t at = all.find(from); at != std::string::npos; ++count) {
                all.replace(at, from.size(), to);
                at = all.find(from, at + to.size());
            }
            EXPECT_GT(count, 0U) << from << " is not in " << name;
        };
        for (const auto &[from, to] : changes) {
            replace_all(from, to);
        }
        write(name, all);
        return (folder_ / name).string();
    }
    void write(const std::string &name, const std::string &text) const {
        std::ofstream(folder_ / name) << text;
    }
    std::string read(const std::string &name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name).rdbuf();
        return text.str();
    }

    client::Serial post(const messages::Command &command) {
        const auto posted = machine_->client().post(command);
        EXPECT_TRUE(posted.has_value()) << posted.error().str();
        return posted.value_or(0);
    }
    task::Progress progress(client::Serial command) const {
        return machine_->client().outcome(command).progress;
    }
    std::string reason(client::Serial command) const { return machine_->client().outcome(command).reason; }
    client::Serial ask(const messages::Command &command) {
        const auto id = post(command);
        cycles(3);
        return id;
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) {
            machine_->cycle();
            motion::TraceSample sample;
            while (machine_->channels().trace.pop(sample)) {
                samples_.push_back(sample);
                judge_.sample(sample, motion());
            }
        }
    }
    /// Starts a program.
    void start(const std::string &text) {
        write("p.ngc", text);
        ask(task::SetMode{task::Mode::AUTO});
        ask(task::OpenProgram{(folder_ / "p.ngc").string()});
        run_ = post(task::RunProgram{});
    }
    /// Waits until the work of start() or mdi() is done.
    task::Progress finish(int limit = 200000) {
        for (int i = 0; i < limit && progress(run_) == task::Progress::STARTED; ++i) {
            cycles(1);
        }
        return progress(run_);
    }
    task::Progress mdi(const std::string &line) {
        ask(task::SetMode{task::Mode::MDI});
        run_ = post(task::Mdi{line});
        cycles(1);
        return finish();
    }
    const motion::Status &motion() const { return machine_->task().motion_status(); }
    double x() const { return motion().carte_pos_cmd.x(); }
    bool pin(const std::string &name) const { return machine_->hal().values().get(name)->as_bit(); }
    void set_pin(const std::string &name, const std::string &value) {
        ASSERT_TRUE(machine_->hal().values().set(name, value).has_value());
    }
    std::string messages() {
        std::string all;
        while (const auto message = machine_->client().next_message()) {
            all += message->text + '\n';
        }
        return all;
    }

    std::filesystem::path folder_;
    diagnostics::Sink sink_;
    std::unique_ptr<LoadedConfig> loaded_;
    std::unique_ptr<Machine> machine_;
    std::vector<motion::TraceSample> samples_;
    JointJudge judge_;
    client::Serial run_ = 0;
};

}  // namespace mw::machine
