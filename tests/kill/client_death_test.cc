// SPDX-License-Identifier: GPL-2.0-or-later
// A client is killed with kill -9 while its program cuts: the cut continues, and the client's right to
// operate ends.
#include <iostream>

#include "kill/started_machine.hh"

namespace mw::kill {
namespace {

class ClientDeath : public StartedMachine {
  protected:
    /// A process that has the exclusive right to operate and has started the program. It reports this through
    /// the pipe and waits.
    pid_t start_operator(int said, bool mustRun) const {
        const pid_t process = ::fork();
        if (process != 0) {
            return process;
        }
        auto mine = client::Client::connect(instance);
        const auto isDone = [&](const messages::Command &command) {
            const auto posted = mine->post(command);
            const auto outcome =
                posted.has_value() ? mine->wait(*posted, 30) : std::unexpected(posted.error());
            return outcome.has_value() && outcome->progress == messages::Progress::DONE;
        };
        char answer = mine.has_value() && isDone(messages::ClaimOperation{3600}) ? 'y' : 'n';
        if (answer == 'y' && mustRun) {
            answer = isDone(messages::OpenProgram{folder / "p.ngc"}) &&
                             mine->post(messages::RunProgram{}).has_value()
                         ? 'y'
                         : 'n';
        }
        if (::write(said, &answer, 1) != 1) {
            ::_exit(1);
        }
        while (true) {
            ::pause();
        }
    }
    bool isCutting() {
        static_cast<void>(client->read_status());
        return client->status().task.interp_state != messages::InterpState::IDLE;
    }
};

TEST_F(ClientDeath, TheCutGoesOnAndItsRightToOperateEnds) {
    ASSERT_NO_FATAL_FAILURE(start());
    ASSERT_NO_FATAL_FAILURE(switch_on());
    double slowest_s = 0;
    for (int i = 0; i < count_kills(); ++i) {
        SCOPED_TRACE(i);
        int ends[2];
        ASSERT_EQ(::pipe(ends), 0);
        const pid_t person = start_operator(ends[1], !isCutting());
        char answer = 0;
        ASSERT_EQ(::read(ends[0], &answer, 1), 1);
        ::close(ends[0]);
        ::close(ends[1]);
        ASSERT_EQ(answer, 'y') << content(folder / "log");
        ASSERT_TRUE(client->wait_until([&] { return line_now() > 7; }, 60).has_value());
        const int line = line_now();
        EXPECT_NE(client->status().operation.holder, 0U);
        const auto killed = Clock::now();
        ::kill(person, SIGKILL);
        ::waitpid(person, nullptr, 0);
        const auto ended = client->wait_until(
            [&] { return client->read_status().has_value() && client->status().operation.holder == 0; }, 30);
        ASSERT_TRUE(ended.has_value()) << "its right to operate stays";
        slowest_s = std::max(slowest_s, std::chrono::duration<double>(Clock::now() - killed).count());
        const auto goes_on = client->wait_until([&] { return line_now() > line + 3 || !isCutting(); }, 30);
        ASSERT_TRUE(goes_on.has_value()) << "the cut is stopped";
        // A short program may have ended meanwhile.
        EXPECT_TRUE(isCutting() || client->status().task.programs_ended > 0);
        EXPECT_EQ(client->status().task.state, messages::State::ON);
        ASSERT_NO_FATAL_FAILURE(ask(messages::SetOptionalStop{true}));
    }
    std::cout << count_kills() << " kills; the right to operate ended " << 1000 * slowest_s
              << " ms after the kill at the latest\n";
}

/// A touch-off is on the disk half a second later, even if the machine is killed.
TEST_F(ClientDeath, ATouchOffOutlivesTheMachine) {
    for (int i = 0; i < count_kills(); ++i) {
        SCOPED_TRACE(i);
        ASSERT_NO_FATAL_FAILURE(start());
        ASSERT_NO_FATAL_FAILURE(switch_on());
        ASSERT_NO_FATAL_FAILURE(ask(messages::SetMode{messages::Mode::MDI}));
        ASSERT_NO_FATAL_FAILURE(ask(messages::Mdi{"G10 L2 P3 X" + std::to_string(i + 1) + ".25"}));
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        kill_machine();
        client.reset();
        const std::string wanted = "5261\t" + std::to_string(i + 1) + ".250000\n";
        EXPECT_NE(content(folder / "mill_mm.var").find(wanted), std::string::npos)
            << content(folder / "mill_mm.var");
    }
}

}  // namespace
}  // namespace mw::kill
