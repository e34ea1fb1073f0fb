// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine in virtual time, operated through NML channels.
#include <unistd.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "clients/nml/bridge/bridge.hh"
#include "clients/nml/config/config_file.hh"
#include "clients/nml/message/wire_table.hh"
#include "clients/nml/net/server.hh"
#include "machine/assembly/machine.hh"
#include "machine/config/loaded_config.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/declarations/json.hh"

namespace mw::nml {
namespace {

constexpr std::string_view CHANNELS =
    "B emcCommand {} localhost 8192 0 0 1 16 1001 TCP=1 xdr queue confirm_write serial\n"
    "B emcError {} localhost 8192 0 0 3 16 1003 TCP=1 xdr queue\n"
    "B emcStatus {} localhost 20480 0 0 2 16 1002 TCP=1 xdr\n"
    "P emc emcCommand LOCAL localhost RW 0 1.0 0 0\nP emc emcStatus LOCAL localhost W 0 1.0 0 0\n"
    "P emc emcError LOCAL localhost W 0 1.0 0 0\n"
    "P emcsvr emcCommand LOCAL localhost W 1 1.0 1 2\nP emcsvr emcStatus LOCAL localhost R 1 1.0 1 2\n"
    "P emcsvr emcError LOCAL localhost R 1 1.0 1 2\n"
    "P xemc emcCommand {} localhost W 0 10.0 0 10\nP xemc emcStatus {} localhost R 0 10.0 0 10\n"
    "P xemc emcError {} localhost R 0 10.0 0 10\n";

/// A new machine in emergency stop.
class OneMachine {
  public:
    OneMachine() : loaded_(machine::LoadedConfig::load(MW_SOURCE_DIR "/configs/sim/mill_mm.ini", sink_)) {
        loaded_->machine.task.parameter_file.clear();
        auto made =
            machine::make_virtual_machine({loaded_->ini, loaded_->reader, loaded_->machine, sink_}, {});
        EXPECT_TRUE(made.has_value()) << (made.has_value() ? "" : made.error().str());
        machine_ = std::move(*made);
    }
    machine::Machine &operator*() { return *machine_; }
    machine::Machine *operator->() { return machine_.get(); }

  private:
    diagnostics::Sink sink_;
    std::unique_ptr<machine::LoadedConfig> loaded_;
    std::unique_ptr<machine::Machine> machine_;
};

/// A machine whose operator uses only NML.
class NmlMachine {
  public:
    explicit NmlMachine(bool isRemote = false) : client_(*client::Client::join(machine_->mailbox())) {
        diagnostics::Sink sink;
        const std::string place = isRemote ? "REMOTE" : "LOCAL";
        config_ =
            parse_config(fmt::format(fmt::runtime(CHANNELS), "SHMEM", "SHMEM", "SHMEM", place, place, place),
                         "m.nml", sink);
        EXPECT_FALSE(sink.hasErrors());
        for (BufferSettings &buffer : config_.buffers) {
            buffer.tcp_port = 0;
        }
        for (const BufferSettings &buffer : config_.buffers) {
            masters_.push_back(
                open_buffer(buffer, *config_.find_process("emcsvr", buffer.name), instance_, local_).value());
        }
        if (isRemote) {
            server_ = Server::start(config_, "emcsvr", instance_, vocabulary_, local_).value();
            for (BufferSettings &buffer : config_.buffers) {
                buffer.tcp_port = server_->tcp_port();
            }
        }
        bridge_ = Bridge::open({config_, "emc", instance_, vocabulary_, local_}, client_).value();
        const Connections mine{config_, "xemc", instance_, vocabulary_, local_};
        commands_ = std::make_unique<Channel>(Channel::open(mine, COMMAND_CHANNEL).value());
        statuses_ = std::make_unique<Channel>(Channel::open(mine, STATUS_CHANNEL).value());
        errors_ = std::make_unique<Channel>(Channel::open(mine, ERROR_CHANNEL).value());
    }

    /// `between` runs while there is no bridge.
    void restart_bridge(const std::function<void()> &between) {
        bridge_.reset();
        between();
        bridge_ = Bridge::open({config_, "emc", instance_, vocabulary_, local_}, client_).value();
    }

    template <class Body>
    WriteNumber send(const Body &body) {
        CommandMessage<Body> message{{}, body};
        return send(view(message));
    }
    WriteNumber send(const MessageView &message) {
        const auto number = commands_->write(message);
        EXPECT_TRUE(number.has_value()) << (number.has_value() ? "" : number.error().str());
        return number.value_or(0);
    }
    /// The bridge has not run for this time.
    void pause(std::chrono::nanoseconds time) { now_ += time; }
    void cycle() {
        const auto before = bridge_->step(now_);
        machine_->cycle();
        const auto after = bridge_->step(now_);
        EXPECT_TRUE(before.has_value() && after.has_value());
    }
    /// The current contents of the status channel.
    StatusMessage<messages::MachineStatus> status() {
        auto message = statuses_->peek();
        EXPECT_TRUE(message.has_value() && message->has_value());
        return {*(*message)->status_head(), *(*message)->get<messages::MachineStatus>()};
    }
    /// Cycles until the command with that serial number has ended, or `most` cycles.
    StatusHead end_of(WriteNumber serial, int most = 60000) {
        StatusHead head;
        for (int i = 0; i < most; ++i) {
            cycle();
            head = status().head;
            if (head.echo_serial_number == serial && head.state != CommandState::EXECUTING) {
                break;
            }
        }
        return head;
    }
    template <class Body>
    StatusHead done(const Body &body) {
        return end_of(send(body));
    }
    /// The next line for the operator.
    std::string error_line() {
        auto message = errors_->read();
        if (!message.has_value() || !message->has_value()) {
            return "none";
        }
        const auto *error = (*message)->get<messages::OperatorError>();
        return error != nullptr ? error->text : (*message)->kind().name();
    }
    OneMachine &machine() { return machine_; }
    Channel &commands() { return *commands_; }
    Vocabulary &vocabulary() { return vocabulary_; }

  private:
    OneMachine machine_;
    client::Client client_;
    Config config_;
    Vocabulary vocabulary_ = Vocabulary::standard();
    LocalPlaces local_;
    std::string instance_ = "nmlsim" + std::to_string(::getpid());
    std::vector<std::unique_ptr<Buffer>> masters_;
    std::unique_ptr<Server> server_;
    std::unique_ptr<Bridge> bridge_;
    Bridge::Clock::time_point now_{};
    std::unique_ptr<Channel> commands_, statuses_, errors_;
};

void expect_done(const StatusHead &head) {
    EXPECT_EQ(head.state, CommandState::DONE) << head.reason.view();
}

void operate(NmlMachine &machine) {
    using namespace messages;
    expect_done(machine.done(SetState{State::ESTOP_RESET}));
    expect_done(machine.done(SetState{State::ON}));
    expect_done(machine.done(HomeJoint{-1}));
    expect_done(machine.done(SetMode{Mode::MDI}));
    const StatusHead moved = machine.done(Mdi{"G53 G0 X12.5 Y3"});
    expect_done(moved);
    EXPECT_EQ(moved.command_type, 509);
    const auto status = machine.status();
    EXPECT_TRUE(status.body.trajectory.isAllHomed);
    EXPECT_NEAR(status.body.trajectory.position_cmd[0], 12.5, 1e-9);
    EXPECT_EQ(status.body.task.mode, Mode::MDI);
    expect_done(machine.done(SetMode{Mode::MANUAL}));
    expect_done(machine.done(SetTeleop{true}));
    expect_done(machine.done(JogIncrement{false, 1, 10, -2}));
}

TEST(NmlMachine, AnOperatorWithSharedMemoryHomesMovesAndJogs) {
    NmlMachine machine;
    operate(machine);
}

TEST(NmlMachine, AnOperatorOverTcpHomesMovesAndJogs) {
    NmlMachine machine(true);
    operate(machine);
}

TEST(NmlMachine, EachCommandIsEchoedWithItsSerialNumberAndEndsWithItsStateAndReason) {
    using namespace messages;
    NmlMachine machine;
    const WriteNumber first = machine.send(Null{});
    const WriteNumber second = machine.send(Mdi{"G0 X1"});
    EXPECT_EQ(second, first + 1) << "one count for all writers";
    const StatusHead head = machine.end_of(second);
    EXPECT_EQ(head.state, CommandState::ERROR);
    EXPECT_EQ(head.command_type, 509);
    EXPECT_FALSE(head.reason.empty());
    EXPECT_NE(machine.error_line(), "none") << "the operator gets a message, too";
    expect_done(machine.done(SetState{State::ESTOP_RESET}));
    EXPECT_TRUE(machine.status().head.reason.empty());
}

TEST(NmlMachine, ValuesOutOfRangeAndWhatIsNoCommandAreRefusedWithTheReasonAndNothingElseHappens) {
    using namespace messages;
    NmlMachine machine;
    const StatusHead far = machine.done(JogStop{true, 99});
    EXPECT_EQ(far.state, CommandState::ERROR);
    EXPECT_EQ(far.reason.view(), "JogStop: index is 99, allowed is 0 to 15");
    StatusMessage<IoStatus> io;
    const StatusHead status = machine.end_of(machine.send(view(io)));
    EXPECT_EQ(status.state, CommandState::ERROR);
    EXPECT_EQ(status.reason.view(), "EMC_IO_STAT_TYPE is no command of this machine");
    const auto rubbish = machine.commands().buffer().write("rubbish", FOREVER);
    const StatusHead bad = machine.end_of(*rubbish);
    EXPECT_EQ(bad.state, CommandState::ERROR);
    EXPECT_NE(bad.reason.view().find("too few for a message"), std::string::npos) << bad.reason.view();
    expect_done(machine.done(Null{}));
}

TEST(NmlMachine, MoreCommandsThanTheMailboxTakesInACycleAllComeInTheirOrder) {
    using namespace messages;
    NmlMachine machine;
    WriteNumber last = 0;
    for (int i = 0; i < 60; ++i) {
        last = machine.send(OperatorDisplay{std::to_string(i)});
    }
    machine.end_of(last);
    EXPECT_EQ(machine.status().head.echo_serial_number, last);
    EXPECT_EQ(machine.status().body.last_message, 60U);
}

TEST(NmlMachine, LinesForTheOperatorComeOnceAndWaitWhileNobodyReadsThem) {
    using namespace messages;
    NmlMachine machine;
    for (int i = 0; i < 30; ++i) {
        machine.done(OperatorError{std::string(500, static_cast<char>('a' + i % 26))});
    }
    int lines = 0;
    for (std::string line = machine.error_line(); line != "none"; line = machine.error_line()) {
        EXPECT_EQ(line, std::string(500, static_cast<char>('a' + lines % 26)));
        ++lines;
        machine.cycle();
    }
    EXPECT_EQ(lines, 30);
}

TEST(NmlMachine, CommandsThatWereSentBeforeTheChannelsWereUpAreDroppedAndToldNotCarriedOut) {
    using namespace messages;
    NmlMachine machine;
    expect_done(machine.done(SetState{State::ESTOP_RESET}));
    machine.restart_bridge([&machine] {
        machine.send(SetState{State::ON});
        machine.send(Mdi{"G0 X1"});
    });
    for (int i = 0; i < 100; ++i) {
        machine.cycle();
    }
    EXPECT_EQ(machine.status().body.task.state, State::ESTOP_RESET);
    EXPECT_EQ(machine.error_line(),
              "2 commands are dropped: they were sent before the machine's channels were up");
    expect_done(machine.done(SetState{State::ON}));
}

TEST(NmlMachine, CommandsThatWaitedWhileTheirServerDidNotRunAreRejectedButForStops) {
    using namespace messages;
    NmlMachine machine;
    expect_done(machine.done(SetState{State::ESTOP_RESET}));
    machine.pause(std::chrono::seconds(1));
    expect_done(machine.done(SetState{State::ON}));
    const WriteNumber mode = machine.send(SetMode{Mode::MDI});
    const WriteNumber stop = machine.send(SetState{State::ESTOP});
    machine.pause(Bridge::STALL_LIMIT + std::chrono::milliseconds(1));
    EXPECT_EQ(machine.end_of(stop).state, CommandState::DONE);
    const auto status = machine.status();
    EXPECT_EQ(status.body.task.state, State::ESTOP);
    EXPECT_EQ(status.body.task.mode, Mode::MANUAL);
    for (const CommandOutcome &one : status.head.recent) {
        EXPECT_TRUE(one.serial_number != mode || one.state == CommandState::ERROR);
    }
    EXPECT_EQ(machine.error_line(), "the NML server did not run while the command waited: send it again");
    expect_done(machine.done(SetState{State::ESTOP_RESET}));
}

/// Cycles for each command; a longer command is then still active on both machines.
constexpr int CYCLES_EACH = 20;

/// The fields that can be compared in the statuses of two machines.
std::string comparable(messages::MachineStatus status) {
    return messages::to_json(messages::object(static_cast<const messages::MachineStatus &>(status)));
}

void put_texts(const messages::Object &body) {
    for (const messages::Field &field : body.declaration->fields) {
        if (field.type.kind == messages::Kind::TEXT) {
            *static_cast<std::string *>(field.at(body.data)) = "G0 X1";
        }
    }
}

/// Every command in emergency stop, then every command switched on.
std::vector<messages::Command> all_commands() {
    std::vector<messages::Command> all;
    const auto add_each = [&all] {
        for (const messages::Declaration *declaration : messages::command_declarations()) {
            all.push_back(*messages::make_command(declaration->number));
            put_texts(messages::object(all.back()));
        }
    };
    add_each();
    all.emplace_back(messages::SetState{messages::State::ESTOP_RESET});
    all.emplace_back(messages::SetState{messages::State::ON});
    add_each();
    return all;
}

/// Progress of a command after CYCLES_EACH, and the state of the machine.
struct Seen {
    CommandState state;
    std::string reason, status;
};

std::vector<Seen> seen_through_the_mailbox(std::vector<messages::Command> commands) {
    OneMachine machine;
    auto client = *client::Client::join(machine->mailbox());
    std::vector<Seen> all;
    for (const messages::Command &command : commands) {
        const auto serial = client.post(command);
        EXPECT_TRUE(serial.has_value()) << serial.error().str();
        for (int i = 0; i < CYCLES_EACH; ++i) {
            machine->cycle();
        }
        const auto outcome = client.outcome(serial.value_or(0));
        EXPECT_TRUE(client.read_status().has_value());
        const CommandState state = outcome.progress == messages::Progress::STARTED ? CommandState::EXECUTING
                                   : outcome.progress == messages::Progress::DONE  ? CommandState::DONE
                                                                                   : CommandState::ERROR;
        all.push_back({state, outcome.reason.substr(0, 255), comparable(client.status())});
    }
    return all;
}

/// Two machines get the same commands at the same cycles: one from a client of its mailbox, one through NML.
TEST(NmlMachine, EveryCommandDoesThroughNmlWhatItDoesThroughTheMailbox) {
    std::vector<messages::Command> commands = all_commands();
    const std::vector<Seen> expected = seen_through_the_mailbox(commands);
    NmlMachine machine;
    std::map<CommandState, int> count;
    for (std::size_t n = 0; n < commands.size(); ++n) {
        const messages::Object body = messages::object(commands[n]);
        const std::string name = fmt::format("{} {}", n, body.declaration->name);
        CommandHead head;
        const WriteNumber number = machine.send({messages::object(head), body});
        for (int i = 0; i < CYCLES_EACH; ++i) {
            machine.cycle();
        }
        const auto status = machine.status();
        EXPECT_EQ(status.head.echo_serial_number, number) << name;
        EXPECT_EQ(status.head.command_type, body.declaration->number) << name;
        EXPECT_EQ(status.head.state, expected[n].state) << name << ": " << expected[n].reason;
        EXPECT_EQ(status.head.reason.view(), expected[n].reason) << name;
        EXPECT_EQ(comparable(status.body), expected[n].status) << name;
        ++count[status.head.state];
    }
    // Neither side is idle, because each type of end occurs.
    EXPECT_GE(count[CommandState::DONE], 80)
        << "refused " << count[CommandState::ERROR] << ", going on " << count[CommandState::EXECUTING];
    EXPECT_GE(count[CommandState::ERROR], 70);
}

TEST(NmlMachine, AMessageWithoutACommandIsRejectedWithItsReasonWhateverItsFieldsAre) {
    NmlMachine machine(true);
    for (const MessageKind &kind : wire_messages()) {
        if (kind.rejection == nullptr) {
            continue;
        }
        Message message = *machine.vocabulary().make(kind.number);
        const StatusHead head = machine.end_of(machine.send(message.view()), 20);
        EXPECT_EQ(head.state, CommandState::ERROR) << kind.wire_name;
        EXPECT_EQ(head.command_type, kind.number) << kind.wire_name;
        EXPECT_EQ(head.reason.view(), kind.rejection) << kind.wire_name;
        EXPECT_EQ(machine.error_line(), kind.rejection);
    }
    // A client that declares EMC_TRAJ_LINEAR_MOVE with fields.
    std::string bytes("\0\0\0\xdc"
                      "abcd"
                      "\0\0\0\x10"
                      "\0\0\0\0\0\0\0\1"
                      "\x3f\xf8\0\0\0\0\0\0",
                      28);
    const auto number = machine.commands().buffer().write(bytes, Timeout{1});
    ASSERT_TRUE(number.has_value()) << number.error().str();
    const StatusHead head = machine.end_of(*number, 20);
    EXPECT_EQ(head.state, CommandState::ERROR);
    EXPECT_EQ(head.reason.view(), "only programs contain this: send it as G-code, by Mdi");
    EXPECT_EQ(head.command_type, 220);
}

TEST(NmlMachine, OtherNamesOfACommandDoWhatItDoes) {
    NmlMachine machine;
    const auto send = [&](std::string_view name) {
        Message message(*machine.vocabulary().find(name));
        expect_done(machine.end_of(machine.send(message.view())));
        return machine.status().body.task.state;
    };
    EXPECT_EQ(send("EMC_AUX_ESTOP_RESET_TYPE"), messages::State::ESTOP_RESET);
    EXPECT_EQ(send("EMC_TRAJ_ENABLE_TYPE"), messages::State::ON);
    EXPECT_EQ(send("EMC_ABORT_TYPE"), messages::State::ON);
    EXPECT_EQ(send("EMC_TRAJ_DISABLE_TYPE"), messages::State::ESTOP_RESET);
    EXPECT_EQ(send("EMC_AUX_ESTOP_ON_TYPE"), messages::State::ESTOP);
}

}  // namespace
}  // namespace mw::nml
