// SPDX-License-Identifier: GPL-2.0-or-later
// A machine that is cutting is repeatedly killed with kill -9, restarts without any manual action, and
// continues its program at the same position.
#include <deque>
#include <iostream>

#include "hal/core/instance.hh"
#include "kill/started_machine.hh"

namespace mw::kill {
namespace {

class KillRecovery : public StartedMachine {
  protected:
    /// Lets the machine cut past line `from` and kills it; returns the bounds of the expected offer.
    struct Bounds {
        int low = 0, high = 0;
    };
    Bounds cut_and_kill(int from, std::chrono::milliseconds cut_for) {
        std::deque<std::pair<Clock::time_point, int>> seen;
        const auto deadline = Clock::now() + std::chrono::seconds(60);
        const auto isUnderWay = [&] { return client->outcome(run).progress == messages::Progress::STARTED; };
        while (Clock::now() < deadline && line_now() <= from && isUnderWay()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        if (line_now() <= from) {  // an overloaded computer has stopped its machine; the position is kept
            ++stopped;
            std::cout << "stopped before line " << from << ": " << client->outcome(run).reason << "\n";
            kill_machine();
            return {from, from};
        }
        const auto end = Clock::now() + cut_for;
        do {
            seen.emplace_back(Clock::now(), line_now());
            while (seen.size() > 1 && seen[1].first + std::chrono::seconds(1) < Clock::now()) {
                seen.pop_front();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while (Clock::now() < end);
        kill_machine();
        return {seen.front().second, line_now()};
    }

    int stopped = 0;
};

TEST_F(KillRecovery, TheProgramGoesOnAtTheRightLineAndNothingHasToBeCleaned) {
    std::srand(static_cast<unsigned>(::getpid()));
    int resumed = 0, latest = 0;
    for (int i = 0; i < count_kills(); ++i) {
        SCOPED_TRACE(i);
        ASSERT_NO_FATAL_FAILURE(start());
        ASSERT_NO_FATAL_FAILURE(switch_on());
        static_cast<void>(client->read_status());
        int from = 6;
        if (client->status().recovery.isOffered) {
            ++resumed;
            from = client->status().recovery.line;
            run = client->post(messages::RecoverProgram{}).value_or(0);
            ASSERT_TRUE(client
                            ->wait_until(
                                [&] {
                                    static_cast<void>(client->read_status());
                                    return client->status().approach.number != 0 ||
                                           client->outcome(run).progress != messages::Progress::STARTED;
                                },
                                30)
                            .has_value())
                << client->outcome(run).reason;
            ASSERT_NO_FATAL_FAILURE(ask(messages::ConfirmApproach{client->status().approach.number}));
        } else {
            ASSERT_NO_FATAL_FAILURE(ask(messages::OpenProgram{folder / "p.ngc"}));
            run = client->post(messages::RunProgram{}).value_or(0);
        }
        const Bounds bounds = cut_and_kill(from, std::chrono::milliseconds(300 + std::rand() % 2500));
        client.reset();
        ASSERT_NO_FATAL_FAILURE(start());
        static_cast<void>(client->read_status());
        const messages::RecoveryStatus offer = client->status().recovery;
        EXPECT_TRUE(offer.isOffered) << offer.refusal.str() << content(folder / "log");
        EXPECT_LE(offer.line, bounds.high) << "later than the tool";
        EXPECT_GE(offer.line, bounds.low) << "more than a second of cutting before the tool";
        latest = std::max(latest, bounds.high - offer.line);
        std::cout << "line " << bounds.low << " a second before, " << bounds.high << " at the kill, "
                  << offer.line << " offered\n";
        if (offer.line > LINES - 200) {
            ASSERT_NO_FATAL_FAILURE(ask(messages::ForgetRecovery{}));
        }
        EXPECT_EQ(content(folder / "mill_mm.tbl"), content(MW_SOURCE_DIR "/configs/sim/mill_mm.tbl"));
        ::kill(machine, SIGTERM);
        ::waitpid(machine, nullptr, 0);
        machine = -1;
        client.reset();
        if (HasFailure()) {
            break;
        }
    }
    EXPECT_LE(stopped, count_kills() / 4) << "hardly anything was cut";
    std::cout << count_kills() << " kills, " << stopped << " of them before it cut, " << resumed
              << " continued after the previous kill; at most " << latest
              << " lines before the executed line\n";
}

/// The kinematics may read the pin while the machine brakes.
TEST_F(KillRecovery, TheToolOffsetStaysOnItsPinUntilTheRealtimeProcessEndsAndComesBackWithTheProgram) {
    constexpr double TOOL_2_LENGTH = 35, NO_PIN = -1;
    const auto offset_now = [](hal::Instance &hal) {
        const auto value = hal.values().get("motion.tooloffset.z");
        return value.has_value() ? value->as_number() : NO_PIN;
    };
    ASSERT_NO_FATAL_FAILURE(start());
    ASSERT_NO_FATAL_FAILURE(switch_on());
    ASSERT_NO_FATAL_FAILURE(ask(messages::OpenProgram{folder / "p.ngc"}));
    auto hal = hal::Instance::attach(instance);
    ASSERT_TRUE(hal.has_value()) << hal.error().str();
    EXPECT_EQ(offset_now(**hal), 0);
    run = client->post(messages::RunProgram{}).value_or(0);
    static_cast<void>(cut_and_kill(6, std::chrono::milliseconds(300)));
    int seen = 0;
    for (double z = 0; z != NO_PIN && !(*hal)->host_status().end_reason().has_value(); ++seen) {
        z = offset_now(**hal);
        ASSERT_TRUE(z == TOOL_2_LENGTH || z == NO_PIN) << z << ", look " << seen;
    }
    EXPECT_GT(seen, 10) << "the realtime process outlives task until the machine is stopped";
    hal->reset();
    client.reset();

    ASSERT_NO_FATAL_FAILURE(start());
    hal = hal::Instance::attach(instance);
    ASSERT_TRUE(hal.has_value()) << hal.error().str();
    static_cast<void>(client->read_status());
    EXPECT_EQ(client->status().offsets.tool.z(), 0);
    EXPECT_EQ(offset_now(**hal), 0);
    ASSERT_NO_FATAL_FAILURE(switch_on());
    run = client->post(messages::RecoverProgram{}).value_or(0);
    const auto isProposed = [&] {
        static_cast<void>(client->read_status());
        return client->status().approach.number != 0 ||
               client->outcome(run).progress != messages::Progress::STARTED;
    };
    ASSERT_TRUE(client->wait_until(isProposed, 30).has_value()) << client->outcome(run).reason;
    ASSERT_NO_FATAL_FAILURE(ask(messages::ConfirmApproach{client->status().approach.number}));
    const int offered = client->status().recovery.line;
    ASSERT_TRUE(client->wait_until([&] { return line_now() > std::max(offered, 6); }, 60).has_value());
    EXPECT_EQ(offset_now(**hal), TOOL_2_LENGTH);
    EXPECT_EQ(client->status().offsets.tool.z(), TOOL_2_LENGTH);
    kill_machine();
}

}  // namespace
}  // namespace mw::kill
