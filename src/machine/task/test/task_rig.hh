// SPDX-License-Identifier: GPL-2.0-or-later
// Task with one client and a motion controller that answers at once, switched on, in virtual time.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "machine/task/task.hh"
#include "machine/task/test/fake_motion.hh"
#include "machine/task/test/tools.hh"
#include "messages/client/client.hh"

namespace mw::task {

namespace fs = std::filesystem;

/// Only pins that a test creates.
class TestParameters final : public gcode::ParameterSource {
  public:
    std::function<double()> on_hal_value;

  private:
    std::optional<double> ini_value(std::string_view, std::string_view) const override { return {}; }
    std::optional<double> hal_value(std::string_view) const override {
        return on_hal_value ? std::optional(on_hal_value()) : std::nullopt;
    }
};

class LoopedIo final : public IoPins {
  public:
    io::Inputs read() override {
        io::Inputs in;
        in.emc_enable_in = outputs.user_enable_out && isChainClosed;
        in.tool_prepared = outputs.tool_prepare;
        in.tool_changed = outputs.tool_change && changer_working;
        return in;
    }
    void write(const io::Outputs &o) override { outputs = o; }
    bool isPersonAsked() const override { return isAsking; }
    void confirm_tool_change() override { isAsking = false; }
    io::Outputs outputs;
    bool isAsking = false;
    bool isChainClosed = true;
    bool changer_working = true;
};

class TaskTest : public testing::Test {
  protected:
    explicit TaskTest(const Settings &settings = {}, journal::Writer *journal = nullptr)
        : channels(std::make_unique_for_overwrite<motion::Channels>()), motion(*channels),
          folder(made_folder()), task({*channels, io, tools, parameters, mailbox.segment(), journal},
                                      settings_for(folder, settings)) {
        EXPECT_TRUE(task.start().has_value());
        EXPECT_EQ(ask(SetState{State::ESTOP_RESET}), Progress::DONE);
        EXPECT_EQ(ask(SetState{State::ON}), Progress::DONE);
    }
    ~TaskTest() override { fs::remove_all(folder); }

    static fs::path made_folder() {
        const fs::path path = fs::temp_directory_path() / ("mw_task_" + std::to_string(::getpid()));
        fs::create_directory(path);
        return path;
    }
    static Settings settings_for(const fs::path &folder, Settings settings) {
        settings.interpreter.user_m_path = {folder.string()};
        settings.interpreter.subroutine_path = {folder.string()};
        settings.user_program_awaited = true;
        return settings;
    }
    void make_program(const std::string &name, const std::string &script) const {
        std::ofstream(folder / name) << "#!/bin/sh\n" << script;
        fs::permissions(folder / name, fs::perms::owner_all);
    }

    void cycle() {
        now_ns += 1000000;
        motion.step();
        task.step(now_ns);
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) {
            cycle();
        }
    }
    client::Serial post(const Command &command) {
        const auto posted = client.post(command);
        EXPECT_TRUE(posted.has_value()) << posted.error().str();
        return posted.value_or(0);
    }
    Progress progress(client::Serial command) { return client.outcome(command).progress; }
    std::string reason(client::Serial command) { return client.outcome(command).reason; }
    Progress ask(const Command &command, int limit = 2500) {
        request = post(command);
        for (int i = 0; i < limit; ++i) {
            cycle();
            if (progress(request) != Progress::STARTED) {
                break;
            }
        }
        return progress(request);
    }
    void open(const std::string &text) {
        std::ofstream(folder / "p.ngc") << text;
        ASSERT_EQ(ask(SetMode{Mode::AUTO}), Progress::DONE);
        ASSERT_EQ(ask(OpenProgram{(folder / "p.ngc").string()}), Progress::DONE) << reason(request);
    }
    std::string joined() const {
        std::string all;
        for (const std::string &one : motion.log) {
            all += (all.empty() ? "" : ", ") + one;
        }
        return all;
    }
    std::string messages() {
        std::string all;
        while (const auto message = client.next_message()) {
            all += message->text + '\n';
        }
        return all;
    }

    std::unique_ptr<motion::Channels> channels;
    test::FakeMotion motion;
    fs::path folder;
    LoopedIo io;
    test::OneTool tools;
    TestParameters parameters;
    mailbox::Memory mailbox = mailbox::Memory::in_process();
    Task task;
    client::Client client = *client::Client::join(mailbox.segment());
    std::int64_t now_ns = 0;
    client::Serial request = 0;
};

}  // namespace mw::task
