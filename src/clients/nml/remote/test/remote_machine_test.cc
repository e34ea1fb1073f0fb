// SPDX-License-Identifier: GPL-2.0-or-later
// Tests clients of a machine behind an NML server, on loopback. The test replaces the machine: it takes
// commands from emcCommand and writes emcStatus.
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <random>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/diagnostics/sink.hh"
#include "clients/nml/bridge/bridge.hh"
#include "clients/nml/config/config_file.hh"
#include "clients/nml/net/server.hh"
#include "clients/nml/remote/find_machine.hh"
#include "clients/nml/remote/remote_machine.hh"
#include "messages/client/client.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/status.hh"

namespace mw::nml {
namespace {

constexpr const char *CONFIG = "B emcCommand SHMEM 127.0.0.1 8192 0 0 1 16 701 TCP={0} xdr queue serial\n"
                               "B emcStatus SHMEM 127.0.0.1 20480 0 0 2 16 702 TCP={0} xdr\n"
                               "B emcError SHMEM 127.0.0.1 8192 0 0 3 16 703 TCP={0} xdr queue\n"
                               "P svr emcCommand LOCAL 127.0.0.1 RW 1 1.0 1 0\n"
                               "P svr emcStatus LOCAL 127.0.0.1 RW 1 1.0 1 0\n"
                               "P svr emcError LOCAL 127.0.0.1 RW 1 1.0 1 0\n"
                               "P xemc emcCommand REMOTE 127.0.0.1 W 0 1.0 0 1\n"
                               "P xemc emcStatus REMOTE 127.0.0.1 R 0 1.0 0 1\n"
                               "P xemc emcError REMOTE 127.0.0.1 R 0 1.0 0 1\n";
/// Above any time limit of the connection.
constexpr double PATIENCE_S = 20;

Config config_of(int port) {
    diagnostics::Sink sink;
    Config config = parse_config(fmt::format(fmt::runtime(CONFIG), 1), "remote.nml", sink);
    EXPECT_FALSE(sink.hasErrors());
    for (BufferSettings &buffer : config.buffers) {
        buffer.tcp_port = port;  // 0, which a file cannot have, selects a free port
    }
    return config;
}

/// The outcome of a command.
struct Taken {
    std::uint64_t number = 0;
    std::string line;
};

class RemoteMachineTest : public ::testing::Test {
  protected:
    RemoteMachineTest() {
        config_ = config_of(0);
        const Connections connections{config_, "svr", instance_, vocabulary_, local_};
        for (auto &[name, channel] : {std::pair{COMMAND_CHANNEL, &commands_},
                                      {STATUS_CHANNEL, &statuses_},
                                      {ERROR_CHANNEL, &errors_}}) {
            auto opened = Channel::open(connections, name);
            EXPECT_TRUE(opened.has_value()) << opened.error().str();
            channel->emplace(std::move(*opened));
        }
        serve();
        config_ = config_of(server_->tcp_port());
    }

    void serve() {
        auto server = Server::start(config_, "svr", instance_, vocabulary_, local_);
        ASSERT_TRUE(server.has_value()) << server.error().str();
        server_ = std::move(*server);
    }
    /// The result of `act`, while the machine writes its status.
    template <class Act>
    auto alive(Act act) {
        auto result = std::async(std::launch::async, act);
        constexpr std::chrono::milliseconds CYCLE{2};
        while (result.wait_for(CYCLE) != std::future_status::ready) {
            publish(status_->body.task.motion_line);
        }
        return result.get();
    }
    Result<std::shared_ptr<RemoteMachine>> connect() { return RemoteMachine::connect(config_, "xemc", 0); }
    Result<std::shared_ptr<RemoteMachine>> connect_alive() {
        return alive([this] { return connect(); });
    }
    static client::Client client_of(const std::shared_ptr<RemoteMachine> &machine) {
        return client::Client::join(client::Viewer(machine)).value();
    }

    void publish(int motion_line = 0) {
        status_->body.task.motion_line = motion_line;
        ASSERT_TRUE(statuses_->write(view(*status_), {PATIENCE_S}).has_value());
    }
    Taken take() {
        auto message = commands_->wait({PATIENCE_S});
        if (!message.has_value() || !message->has_value()) {
            ADD_FAILURE() << "no command came";
            return {};
        }
        const auto *const mdi = (*message)->get<messages::Mdi>();
        const std::uint64_t number = (*message)->command_head()->serial_number;
        note(number, CommandState::EXECUTING, "");
        return {number, mdi != nullptr ? mdi->line : ""};
    }
    void note(std::uint64_t number, CommandState state, const std::string &reason) {
        auto &recent = status_->head.recent;
        auto one = std::ranges::find(recent, number, &CommandOutcome::serial_number);
        if (one == recent.end()) {
            one = recent.begin() + static_cast<std::ptrdiff_t>(taken_++ % RECENT_COMMANDS);
        }
        *one = {number, state, {}};
        one->reason.assign(reason);
        status_->head.echo_serial_number = std::max(status_->head.echo_serial_number, number);
    }
    /// From now on the status contains the outcome of the command.
    void end(std::uint64_t number, CommandState state, const std::string &reason = "") {
        note(number, state, reason);
        publish();
    }

    Vocabulary vocabulary_ = Vocabulary::standard();
    LocalPlaces local_;
    std::string instance_ = "remote" + std::to_string(::getpid());
    Config config_;
    std::optional<Channel> commands_, statuses_, errors_;
    std::unique_ptr<Server> server_;
    std::unique_ptr<StatusMessage<messages::MachineStatus>> status_ =
        std::make_unique<StatusMessage<messages::MachineStatus>>();
    std::size_t taken_ = 0;
};

TEST_F(RemoteMachineTest, TwoClientsEachHaveTheOutcomesOfTheirOwnCommands) {
    publish(5);
    const auto first = connect_alive(), second = connect_alive();
    ASSERT_TRUE(first.has_value() && second.has_value());
    client::Client a = client_of(*first), b = client_of(*second);
    const client::Serial of_a = a.post(messages::Mdi{"G0 X1"}).value();
    const Taken taken_a = take();
    const client::Serial of_b = b.post(messages::Mdi{"G0 X2"}).value();
    const Taken taken_b = take();
    EXPECT_EQ(of_a, of_b) << "each process counts its own commands";
    EXPECT_EQ(taken_a.line + taken_b.line, "G0 X1G0 X2");
    EXPECT_EQ(taken_a.number + 1, taken_b.number) << "the server counts those of all";
    end(taken_b.number, CommandState::DONE);
    EXPECT_EQ(b.wait(of_b, PATIENCE_S).value().progress, messages::Progress::DONE);
    end(taken_a.number, CommandState::ERROR, "X is not homed");
    const auto outcome = a.wait(of_a, PATIENCE_S).value();
    EXPECT_EQ(outcome.progress, messages::Progress::FAILED);
    EXPECT_EQ(outcome.reason, "X is not homed");
    publish(77);
    for (client::Client *one : {&a, &b}) {
        EXPECT_TRUE(
            one->wait_until(
                   [&] { return one->read_status().has_value() && one->status().task.motion_line == 77; },
                   PATIENCE_S)
                .has_value());
    }
}

TEST_F(RemoteMachineTest, ManyCommandsOfTwoClientsAreNotConfused) {
    constexpr int COMMANDS = 40;
    publish();
    std::vector<std::jthread> clients;
    for (int who = 0; who < 2; ++who) {
        const auto machine = connect_alive();
        ASSERT_TRUE(machine.has_value()) << machine.error().str();
        clients.emplace_back([who, machine = *machine] {
            client::Client mine = client_of(machine);
            for (int i = 0; i < COMMANDS; ++i) {
                const std::string line = fmt::format("({} {})", who, i);
                const auto outcome = mine.wait(mine.post(messages::Mdi{line}).value(), PATIENCE_S);
                ASSERT_TRUE(outcome.has_value()) << outcome.error().str();
                const bool is_good = i % 3 != who;
                EXPECT_EQ(outcome->progress, is_good ? messages::Progress::DONE : messages::Progress::FAILED);
                EXPECT_EQ(outcome->reason, is_good ? "" : line);
            }
        });
    }
    // One command of each client in turn, so that neither has more commands than a status has outcomes.
    for (int i = 0; i < COMMANDS; ++i) {
        const std::array both{take(), take()};
        for (const Taken &taken : {both[1], both[0]}) {
            ASSERT_GT(taken.line.size(), 3U);
            const int who = taken.line[1] - '0', number = std::stoi(taken.line.substr(3));
            const bool is_good = number % 3 != who;
            end(taken.number, is_good ? CommandState::DONE : CommandState::ERROR, is_good ? "" : taken.line);
        }
    }
}

TEST_F(RemoteMachineTest, AMachineThatSendsNoStatusIsLostWithinItsLimit) {
    const auto machine = connect_alive();
    ASSERT_TRUE(machine.has_value());
    client::Client mine = client_of(*machine);
    const client::Serial serial = mine.post(messages::Mdi{"G0 X1"}).value();
    take();
    const auto begin = std::chrono::steady_clock::now();
    const auto outcome = mine.wait(serial, PATIENCE_S);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(6));
    EXPECT_TRUE(!outcome.has_value() || outcome->progress == messages::Progress::FAILED);
    const auto found = (*machine)->check();
    ASSERT_FALSE(found.has_value());
    EXPECT_NE(found.error().str().find(fmt::format("127.0.0.1:{}", server_->tcp_port())), std::string::npos)
        << found.error().str();
    EXPECT_FALSE(connect().has_value()) << "the status that is there is that of the past";
}

TEST_F(RemoteMachineTest, AStatusThatIsNoneIsAnErrorThatNamesTheServer) {
    std::string whole;
    ASSERT_TRUE(Codec(vocabulary_, Encoding::XDR).encode(view(*status_), whole).has_value());
    std::string command;
    CommandMessage<messages::Mdi> mdi{{1}, {"G0 X1"}};
    ASSERT_TRUE(Codec(vocabulary_, Encoding::XDR).encode(view(mdi), command).has_value());
    std::string other_version = whole;
    other_version[7] = static_cast<char>(other_version[7] ^ 1);  // another shape means other fields
    std::vector<std::string> wrong{"garbage",
                                   std::string(4, '\0'),
                                   whole.substr(0, whole.size() / 2),
                                   whole.substr(0, whole.size() - 8),
                                   whole + std::string(8, '\1'),
                                   command,
                                   other_version};
    std::mt19937 random(7);
    for (int i = 0; i < 20; ++i) {
        std::string bytes(random() % 400, '\0');
        for (char &one : bytes) {
            one = static_cast<char>(random());
        }
        wrong.push_back(bytes);
    }
    const std::string name = fmt::format("127.0.0.1:{}", server_->tcp_port());
    for (std::size_t i = 0; i < wrong.size(); ++i) {
        publish();
        const auto machine = connect_alive();
        ASSERT_TRUE(machine.has_value()) << i << machine.error().str();
        ASSERT_TRUE(statuses_->buffer().write(wrong[i], {PATIENCE_S}).has_value());
        client::Viewer viewer(*machine);
        EXPECT_FALSE(viewer.wait_until([] { return false; }, PATIENCE_S).has_value());
        const auto found = (*machine)->check();
        ASSERT_FALSE(found.has_value()) << i;
        EXPECT_NE(found.error().str().find(name), std::string::npos) << found.error().str();
        const auto again = connect();
        ASSERT_FALSE(again.has_value()) << i;
        EXPECT_NE(again.error().str().find(name), std::string::npos) << again.error().str();
    }
}

/// Accepts clients and sends each the same bytes, or nothing.
class WrongServer {
  public:
    explicit WrongServer(std::string answer) : answer_(std::move(answer)) {
        socket_ = listen_at("127.0.0.1", port_, Transport::TCP).value();
        thread_ = std::jthread([this](const std::stop_token &stop) {
            std::vector<Socket> clients;
            while (!stop.stop_requested()) {
                pollfd one{socket_.fd(), POLLIN, 0};
                constexpr int LOOK_MS = 20;
                if (::poll(&one, 1, LOOK_MS) > 0) {
                    clients.emplace_back(
                        ::accept4(socket_.fd(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
                    static_cast<void>(clients.back().send(answer_, Deadline({1.0})));
                }
            }
        });
    }
    int port() const { return port_; }

  private:
    std::string answer_;
    int port_ = 0;
    Socket socket_;
    std::jthread thread_;
};

TEST_F(RemoteMachineTest, AServerOfAnotherProtocolOrVersionIsAnError) {
    const std::string good = to_wire({Operation::READ, Status::DONE, 2, 1, 1, 0, "12345678"});
    std::string version = good, large = good, other = good;
    version[3] = '\x07';
    large.replace(28, 4, "\x7f\xff\xff\xff");
    other[15] = '\x55';
    for (const std::string &answer :
         {std::string("HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"), version,
          large, other, good, std::string(200, '\xff')}) {
        const WrongServer server(answer);
        config_ = config_of(server.port());
        const auto machine = connect();
        ASSERT_FALSE(machine.has_value());
        EXPECT_NE(machine.error().str().find(fmt::format("127.0.0.1:{}", server.port())), std::string::npos)
            << machine.error().str();
    }
}

TEST_F(RemoteMachineTest, AServerThatNeverAnswersIsAnErrorWithinItsLimit) {
    const WrongServer server("");
    config_ = config_of(server.port());
    const auto begin = std::chrono::steady_clock::now();
    const auto machine = connect();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    EXPECT_FALSE(machine.has_value());
}

class FindMachineTest : public RemoteMachineTest {
  protected:
    FindMachineTest() { write(fmt::format(fmt::runtime(CONFIG), server_->tcp_port())); }
    ~FindMachineTest() override { std::filesystem::remove(path_); }
    void write(const std::string &text) { std::ofstream(path_) << text; }
    Result<client::Viewer> find() { return find_machine("nowhere" + instance_, path_); }
    std::string why() {
        const auto found = find();
        return found.has_value() ? "" : found.error().str();
    }
    std::string path_ = std::filesystem::temp_directory_path() / fmt::format("mw_remote_{}.nml", ::getpid());
};

TEST_F(FindMachineTest, AServerThatIsBackIsFoundAndNumbersGoOn) {
    publish(1);
    const auto viewer = alive([this] { return find(); });
    ASSERT_TRUE(viewer.has_value()) << viewer.error().str();
    EXPECT_EQ(find().value().link(), viewer->link()) << "one connection for a process";
    client::Client mine = client::Client::join(find().value()).value();
    const client::Serial serial = mine.post(messages::Mdi{"G0 X1"}).value();
    take();
    server_.reset();
    const auto outcome = mine.wait(serial, PATIENCE_S);
    EXPECT_TRUE(!outcome.has_value() || outcome->progress == messages::Progress::FAILED);
    EXPECT_FALSE(viewer->check_machine().has_value());
    EXPECT_NE(why().find(fmt::format("127.0.0.1:{}", *config_.buffers[0].tcp_port)), std::string::npos)
        << why();
    serve();
    publish(2);
    const auto again = alive([this] { return find(); });
    ASSERT_TRUE(again.has_value()) << again.error().str();
    client::Client other = client::Client::join(*find()).value();
    ASSERT_TRUE(other.read_status().has_value());
    EXPECT_EQ(other.status().task.motion_line, 2);
    const client::Serial next = other.post(messages::Mdi{"G0 X2"}).value();
    EXPECT_GT(next, serial) << "a client that compares numbers sees them rise";
    const Taken taken = take();
    EXPECT_EQ(taken.line, "G0 X2") << "nothing is sent twice";
    end(taken.number, CommandState::DONE);
    EXPECT_EQ(other.wait(next, PATIENCE_S).value().progress, messages::Progress::DONE);
}

TEST_F(FindMachineTest, AFileThatIsMissingOrWrongIsAnErrorThatNamesIt) {
    const std::string good = fmt::format(fmt::runtime(CONFIG), server_->tcp_port());
    const auto without = [&good](const std::string &begin) {
        const std::size_t from = good.find(begin);
        return good.substr(0, from) + good.substr(good.find('\n', from) + 1);
    };
    write(without("P xemc emcStatus"));
    EXPECT_NE(why().find(path_ + ": no P line for process 'xemc' and buffer 'emcStatus'"), std::string::npos)
        << why();
    write(without("B emcError"));
    EXPECT_NE(why().find("emcError"), std::string::npos) << why();
    write(without("B emcStatus") + "B emcStatus SHMEM\n");
    EXPECT_NE(why().find(path_ + ":"), std::string::npos) << why();
    write("");
    EXPECT_NE(why().find(path_), std::string::npos) << why();
    std::filesystem::remove(path_);
    EXPECT_NE(why().find(path_), std::string::npos) << why();
    path_ = std::filesystem::temp_directory_path();
    EXPECT_NE(why().find(path_), std::string::npos) << "a folder: " << why();
    path_ = "/no/such/file";
}

}  // namespace
}  // namespace mw::nml
