// SPDX-License-Identifier: GPL-2.0-or-later
// Checks every command in every situation, and random sequences against a small model without tables.
#include <random>

#include "machine/task/run/admission.hh"
#include "machine/task/test/task_rig.hh"
#include "messages/declarations/catalogue.hh"

namespace mw::task {
namespace {

TEST(TaskStates, ThePageNamesEachCommand) {
    const std::string page = states_page();
    for (const messages::Declaration *d : messages::command_declarations()) {
        EXPECT_NE(page.find(d->name), std::string::npos) << d->name;
    }
}

class SituationsTest : public TaskTest {
  protected:
    static constexpr const char *PROGRAM = "G21 F600\nG1 X1\nM0\nG1 X2\nM2\n";

    /// From any situation: ends everything, then enters the situation.
    void enter(Situation situation) {
        motion.isHolding = false;
        ask(AbortAll{});
        cycles(10);
        ask(SetState{State::ESTOP_RESET});
        ask(SetState{State::ON});
        ask(SetMode{Mode::MANUAL});
        switch (situation) {
        case Situation::ESTOP: ask(SetState{State::ESTOP}); break;
        case Situation::OFF: ask(SetState{State::OFF}); break;
        case Situation::MANUAL: break;
        case Situation::AUTO_IDLE: open(PROGRAM); break;
        case Situation::AUTO_RUNNING: run(); break;
        case Situation::AUTO_HELD:
            run();
            ask(PauseProgram{});
            break;
        case Situation::MDI_IDLE: ask(SetMode{Mode::MDI}); break;
        case Situation::MDI_RUNNING: line(); break;
        case Situation::MDI_HELD:
            line();
            ask(PauseProgram{});
            break;
        case Situation::AUTO_PROPOSED:
        case Situation::AUTO_AWAY:
        case Situation::COUNT: FAIL() << "shown with what leads there";
        }
        cycles(5);
    }
    void run() {
        open(PROGRAM);
        motion.isHolding = true;
        post(RunProgram{});
        cycles(5);
    }
    void line() {
        ask(SetMode{Mode::MDI});
        motion.isHolding = true;
        post(Mdi{"G21 F600 G1 X3"});
        cycles(5);
    }
    static Command sound(int number) {
        Command command = *messages::make_command(number);
        for (const messages::Field &field : messages::find_declaration(number)->fields) {
            if (field.type.kind == messages::Kind::TEXT && field.range.min > 0) {
                *static_cast<std::string *>(field.at(messages::object(command).data)) = "text";
            }
        }
        return command;
    }
};

TEST_F(SituationsTest, EveryCommandInEverySituationIsTakenOrRefusedAsTheTableSays) {
    int taken = 0, refused = 0;
    for (int at = 0; at < static_cast<int>(Situation::COUNT); ++at) {
        const auto situation = static_cast<Situation>(at);
        if (situation == Situation::AUTO_PROPOSED || situation == Situation::AUTO_AWAY) {
            continue;
        }
        for (const messages::Declaration *declaration : messages::command_declarations()) {
            SCOPED_TRACE(std::string(declaration->name) + " in " + std::to_string(at));
            const Command command = sound(declaration->number);
            if (class_of(command, Mode::MANUAL) == CommandClass::OF_THE_MAILBOX) {
                continue;  // these commands do not reach task
            }
            enter(situation);
            const char *const refusal = refusal_of(class_of(command, task.status().task.mode), situation);
            motion.log.clear();
            const auto id = post(command);
            cycles(3);
            if (refusal != nullptr) {
                ++refused;
                EXPECT_EQ(progress(id), Progress::REFUSED);
                EXPECT_EQ(reason(id), refusal);
                EXPECT_EQ(joined(), "") << "a rejected command does nothing";
            } else {
                ++taken;
                EXPECT_TRUE(progress(id) != Progress::REFUSED || !reason(id).empty());
            }
        }
    }
    EXPECT_GT(taken, 400);
    EXPECT_GT(refused, 200);
}

/// An operator's view of the machine, without tables.
struct Model {
    enum class Run { NONE, GOING, HELD };
    State state = State::ON;
    Mode mode = Mode::MANUAL;
    Run run = Run::NONE;
    bool isOpen = false, stop_passed = false;
    int queued = 0;
    static constexpr int MOST_QUEUED = 10;

    bool isOn() const { return state == State::ON; }
    void stop() {
        run = Run::NONE;
        queued = 0;
    }
    bool take(const SetState &c) {
        if (c.state == State::ESTOP) {
            stop();
            state = State::ESTOP;
        } else if (c.state == State::ESTOP_RESET) {
            state = state == State::ESTOP ? State::ESTOP_RESET : state;
        } else if (c.state == State::OFF) {
            stop();
            state = state == State::ON ? State::ESTOP_RESET : state;
        } else if (state == State::ESTOP) {
            return false;
        } else {
            state = State::ON;
        }
        return true;
    }
    bool take(const SetMode &c) {
        const bool allowed = c.mode == mode || run == Run::NONE;
        mode = allowed ? c.mode : mode;
        return allowed;
    }
    bool take(const RunProgram &) {
        const bool allowed = isOn() && mode == Mode::AUTO && run == Run::NONE && isOpen;
        run = allowed ? Run::GOING : run;
        stop_passed = allowed ? false : stop_passed;
        return allowed;
    }
    bool take(const Mdi &) {
        if (!isOn() || mode != Mode::MDI || (run != Run::NONE && queued >= MOST_QUEUED)) {
            return false;
        }
        queued += run != Run::NONE ? 1 : 0;
        run = run == Run::NONE ? Run::GOING : run;
        return true;
    }
    bool take(const PauseProgram &) {
        run = run != Run::NONE ? Run::HELD : run;
        return isOn();
    }
    bool take(const ResumeProgram &) {
        run = run == Run::HELD ? Run::GOING : run;
        return isOn();
    }
    bool take(const AbortAll &) {
        stop();
        return true;
    }
    bool take(const FloodOn &) { return isOn(); }
    bool take(const JogContinuous &) { return isOn() && mode == Mode::MANUAL; }
    /// Gives motion time to end everything.
    void let_go() {
        if (run != Run::GOING) {
            return;
        }
        if (mode == Mode::AUTO && !stop_passed) {
            run = Run::HELD;
            stop_passed = true;
        } else {
            stop();
        }
    }
};

class ModelTest : public SituationsTest {
  protected:
    template <class C>
    void give(const C &command, const char *name) {
        const bool expected = model.take(command);
        story += std::string(" ") + name;
        const auto id = post(command);
        cycles(8);
        ++(expected ? taken : refused);
        EXPECT_EQ(progress(id) != Progress::REFUSED, expected) << name << ": " << reason(id);
        EXPECT_EQ(reason(id).empty(), expected) << name;
    }
    void one(int choice) {
        switch (choice) {
        case 0: give(SetState{State::ESTOP}, "estop"); break;
        case 1: give(SetState{State::OFF}, "off"); break;
        case 2:
        case 3: give(SetState{State::ESTOP_RESET}, "reset"); break;
        case 4:
        case 5: give(SetState{State::ON}, "on"); break;
        case 6: give(SetMode{Mode::MANUAL}, "manual"); break;
        case 7:
        case 8: give(SetMode{Mode::AUTO}, "auto"); break;
        case 9: give(SetMode{Mode::MDI}, "mdi mode"); break;
        case 10:
        case 11: give(RunProgram{}, "run"); break;
        case 12:
        case 13:
        case 14: give(Mdi{"G21 F600 G1 X3"}, "line"); break;
        case 15: give(PauseProgram{}, "pause"); break;
        case 16:
        case 17: give(ResumeProgram{}, "resume"); break;
        case 18: give(AbortAll{}, "abort"); break;
        case 19: give(FloodOn{}, "flood"); break;
        case 20: give(JogContinuous{true, 0, 1}, "jog"); break;
        default:
            story += " let_go";
            motion.isHolding = model.run == Model::Run::HELD;  // behaves as a paused motion controller
            model.let_go();
            cycles(200);
            motion.isHolding = true;
        }
    }
    void compare() {
        const messages::TaskStatus &now = task.status().task;
        EXPECT_EQ(now.state, model.state);
        EXPECT_EQ(now.mode, model.mode);
        EXPECT_EQ(now.interp_state == InterpState::IDLE, model.run == Model::Run::NONE);
        EXPECT_EQ(now.isPaused, model.run == Model::Run::HELD);
        EXPECT_EQ(now.queued_mdi, model.queued);
    }
    Model model;
    int taken = 0, refused = 0;
    std::string story;  ///< the commands so far
};

TEST_F(ModelTest, RandomCommandsDoWhatASmallModelSays) {
    open(PROGRAM);
    model.isOpen = true;
    model.mode = Mode::AUTO;
    motion.isHolding = true;
    for (unsigned seed = 1; seed <= 60 && !HasFailure(); ++seed) {
        std::mt19937 random(seed);
        story.clear();
        for (int step = 0; step < 60 && !HasFailure(); ++step) {
            SCOPED_TRACE("seed " + std::to_string(seed) + " step " + std::to_string(step));
            one(std::uniform_int_distribution(0, 23)(random));
            compare();
            EXPECT_FALSE(HasFailure()) << story;
        }
    }
    EXPECT_GT(taken, 1000);
    EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace mw::task
