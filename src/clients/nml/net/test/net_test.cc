// SPDX-License-Identifier: GPL-2.0-or-later
// Tests buffers through their server, on loopback.
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "base/diagnostics/sink.hh"
#include "clients/nml/config/config_file.hh"
#include "clients/nml/net/remote_buffer.hh"
#include "clients/nml/net/server.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/status.hh"

namespace mw::nml {
namespace {

constexpr std::string_view SERVED = "B cmd SHMEM 127.0.0.1 8192 0 0 1 8 501 TCP=1 xdr queue\n"
                                    "B sts SHMEM 127.0.0.1 20480 0 0 2 8 502 TCP=1 xdr\n"
                                    "P svr cmd LOCAL 127.0.0.1 RW 1 1.0 1 0\n"
                                    "P svr sts LOCAL 127.0.0.1 RW 1 1.0 1 0\n"
                                    "P gui cmd REMOTE 127.0.0.1 RW 0 1.0 0 1\n"
                                    "P gui sts REMOTE 127.0.0.1 R 0 1.0 0 1\n";

/// Messages of one type as text, without using the codec.
std::string mdi(const Vocabulary &vocabulary, const std::string &line) {
    CommandMessage<messages::Mdi> message{{1}, {line}};
    std::string bytes;
    EXPECT_TRUE(Codec(vocabulary, Encoding::XDR).encode(view(message), bytes).has_value());
    return bytes;
}

class NmlNetTest : public ::testing::Test {
  protected:
    /// Starts a server at a free port, at which clients find it.
    void start(Transport transport = Transport::TCP, const std::string &password_file = "") {
        diagnostics::Sink sink;
        config_ = parse_config(SERVED, "net.nml", sink);
        ASSERT_FALSE(sink.hasErrors());
        for (BufferSettings &buffer : config_.buffers) {
            buffer.tcp_port = transport == Transport::TCP ? std::optional(0) : std::nullopt;
            buffer.udp_port = transport == Transport::UDP ? std::optional(0) : std::nullopt;
            buffer.password_file = password_file;
        }
        for (const char *name : {"cmd", "sts"}) {
            auto buffer = open_buffer(*config_.find_buffer(name), *config_.find_process("svr", name),
                                      instance_, local_);
            ASSERT_TRUE(buffer.has_value()) << buffer.error().str();
            (std::string_view(name) == "cmd" ? cmd_ : sts_) = std::move(*buffer);
        }
        restart();
        for (BufferSettings &buffer : config_.buffers) {
            buffer.tcp_port = transport == Transport::TCP ? std::optional(server_->tcp_port()) : std::nullopt;
            buffer.udp_port = transport == Transport::UDP ? std::optional(server_->udp_port()) : std::nullopt;
        }
    }
    void restart() {
        server_.reset();
        auto server = Server::start(config_, "svr", instance_, vocabulary_, local_);
        ASSERT_TRUE(server.has_value()) << server.error().str();
        server_ = std::move(*server);
    }
    Result<std::unique_ptr<Buffer>> client(const std::string &buffer) {
        return open_any_buffer(config_, "gui", buffer, instance_, local_);
    }

    Vocabulary vocabulary_ = Vocabulary::standard();
    LocalPlaces local_;
    std::string instance_ = "net" + std::to_string(::getpid());
    Config config_;
    std::unique_ptr<Buffer> cmd_, sts_;
    std::unique_ptr<Server> server_;
};

class NmlTransportTest : public NmlNetTest, public ::testing::WithParamInterface<Transport> {};
INSTANTIATE_TEST_SUITE_P(All, NmlTransportTest, ::testing::Values(Transport::TCP, Transport::UDP));

TEST_P(NmlTransportTest, AClientWritesReadsPeeksWaitsAndClearsAsALocalOne) {
    start(GetParam());
    const auto command = client("cmd"), status = client("sts");
    ASSERT_TRUE(command.has_value()) << command.error().str();
    ASSERT_TRUE(status.has_value()) << status.error().str();
    const std::string first = mdi(vocabulary_, "G0 X1"), second = mdi(vocabulary_, "G0 X2");
    EXPECT_EQ((*command)->write(first, {1.0}).value(), 1U);
    EXPECT_EQ((*command)->write(second, {1.0}).value(), 2U);
    Received message;
    ASSERT_TRUE(cmd_->read(message, AT_ONCE).value());
    EXPECT_EQ(message.bytes, first);
    ASSERT_TRUE((*command)->peek(message, AT_ONCE).value());
    EXPECT_EQ(message.bytes, second);
    ASSERT_TRUE((*command)->read(message, AT_ONCE).value());
    EXPECT_EQ(message.number, 2U);
    EXPECT_FALSE((*command)->read(message, AT_ONCE).value());

    EXPECT_FALSE((*status)->read(message, AT_ONCE).value());
    EXPECT_FALSE((*status)->wait(message, {0.01}).value());
    ASSERT_TRUE(sts_->write("anything", AT_ONCE).has_value());
    ASSERT_TRUE((*status)->read(message, {1.0}).value());
    EXPECT_EQ(message.bytes, "anything");
    EXPECT_FALSE((*status)->read(message, {1.0}).value()) << "read already";
    EXPECT_TRUE((*status)->peek(message, {1.0}).value());
    std::jthread writer([this] { EXPECT_TRUE(sts_->write("later", FOREVER).has_value()); });
    EXPECT_TRUE((*status)->wait(message, FOREVER).value());
    EXPECT_EQ(message.bytes, "later");
    writer.join();
    ASSERT_TRUE((*command)->write(first, {1.0}).has_value());
    ASSERT_TRUE((*command)->clear({1.0}).has_value());
    EXPECT_FALSE(cmd_->peek(message, AT_ONCE).value());
}

/// Jogs that the server stops; empty if there is none within a second.
std::vector<messages::Command> left_by(Server &server) {
    for (int i = 0; i < 1000; ++i) {
        auto left = server.take_left_jogs();
        if (!left.empty()) {
            return left;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
}

TEST_F(NmlNetTest, AJogEndsWithTheConnectionThatHasSentIt) {
    start(Transport::TCP);
    const auto jog = [this](Buffer &buffer, int index) {
        CommandMessage<messages::JogContinuous> message{{}, {true, index, 1.0}};
        std::string bytes;
        EXPECT_TRUE(Codec(vocabulary_, Encoding::XDR).encode(view(message), bytes).has_value());
        EXPECT_TRUE(buffer.write(bytes, {1.0}).has_value());
    };
    auto one = client("cmd"), other = client("cmd");
    ASSERT_TRUE(one.has_value() && other.has_value());
    jog(**one, 0);
    jog(**one, 1);
    jog(**other, 1);
    EXPECT_TRUE(server_->take_left_jogs().empty()) << "both live";
    one->reset();
    const auto left = left_by(*server_);
    ASSERT_EQ(left.size(), 1U) << "joint 1 belongs to the other";
    EXPECT_EQ(std::get<messages::JogStop>(left[0]).index, 0);
    other->reset();
    EXPECT_EQ(left_by(*server_).size(), 1U);
}

TEST_P(NmlTransportTest, ALargeStatusComesWhole) {
    start(GetParam());
    const auto status = client("sts");
    ASSERT_TRUE(status.has_value());
    const auto machine = std::make_unique<StatusMessage<messages::MachineStatus>>();
    machine->body.task.motion_line = 77;
    for (CommandOutcome &one : machine->head.recent) {
        one = {~0ULL, CommandState::ERROR, {}};
        one.reason.assign(std::string(255, 'x'));
    }
    machine->head.reason = machine->head.recent[0].reason;
    std::string bytes;
    ASSERT_TRUE(Codec(vocabulary_, Encoding::XDR).encode(view(*machine), bytes).has_value());
    EXPECT_LT(bytes.size(), 20480U) << "with the longest reasons it fits into the usual buffer";
    ASSERT_TRUE(sts_->write(bytes, AT_ONCE).has_value());
    Received message;
    ASSERT_TRUE((*status)->read(message, {5.0}).value());
    EXPECT_EQ(message.bytes, bytes);
}

TEST_P(NmlTransportTest, WhatIsNoMessageIsRefusedAndNobodyGetsIt) {
    start(GetParam());
    const auto command = client("cmd");
    ASSERT_TRUE(command.has_value());
    const auto written = (*command)->write("rubbish", {1.0});
    ASSERT_FALSE(written.has_value());
    EXPECT_NE(written.error().message.find("too few for a message"), std::string::npos)
        << written.error().str();
    Received message;
    EXPECT_FALSE(cmd_->peek(message, AT_ONCE).value());
    EXPECT_TRUE((*command)->write(mdi(vocabulary_, "G0"), {1.0}).has_value())
        << "the connection is as good as before";
}

TEST_P(NmlTransportTest, PasswordsAreAskedForWhereTheConfigurationSaysSo) {
    const auto folder = std::filesystem::temp_directory_path() / ("mw_nml_net" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder);
    const auto write_file = [&folder](const char *name, const char *text, mode_t mode) {
        const std::string path = (folder / name).string();
        std::ofstream(path) << text;
        ::chmod(path.c_str(), mode);
        return path;
    };
    const std::string right = write_file("right", "# who may\nhans:geheim\nanna:auch geheim\n", 0600);
    const std::string wrong = write_file("wrong", "hans:gehein\n", 0600);
    start(GetParam(), right);
    ASSERT_TRUE(client("sts").has_value());
    config_.buffers[1].password_file = wrong;
    const auto refused = client("sts");
    ASSERT_FALSE(refused.has_value());
    EXPECT_NE(refused.error().message.find("name or password are wrong"), std::string::npos);
    config_.buffers[1].password_file = write_file("open", "hans:geheim\n", 0644);
    EXPECT_NE(client("sts").error().message.find("others than its owner"), std::string::npos);
    config_.buffers[1].password_file = write_file("bad", "hans\n", 0600);
    EXPECT_NE(client("sts").error().str().find("bad:1:1: a line of a password file is name:password"),
              std::string::npos);
    config_.buffers[1].password_file.clear();
    const auto without = client("sts");
    ASSERT_TRUE(without.has_value());
    Received message;
    EXPECT_NE((*without)->peek(message, {1.0}).error().message.find("needs a password"), std::string::npos);
    std::filesystem::remove_all(folder);
}

TEST_F(NmlNetTest, AServerListensAtTheAddressOfItsHostAlone) {
    start();
    const auto other = connect_to("127.0.0.2", server_->tcp_port(), Transport::TCP, Deadline({1.0}));
    EXPECT_FALSE(other.has_value()) << "127.0.0.1 is named";
    EXPECT_EQ(server_->udp_port(), 0) << "what has no port is not served";
}

TEST_F(NmlNetTest, AClientFindsItsServerAgainAfterARestart) {
    start();
    const auto status = client("sts");
    ASSERT_TRUE(status.has_value());
    ASSERT_TRUE(sts_->write("one", AT_ONCE).has_value());
    Received message;
    ASSERT_TRUE((*status)->read(message, {1.0}).value());
    server_.reset();
    EXPECT_FALSE((*status)->read(message, {1.0}).has_value());
    EXPECT_NE((*status)->read(message, {1.0}).error().str().find("is its server running?"),
              std::string::npos);
    restart();
    ASSERT_TRUE((*status)->read(message, {1.0}).value()) << "a new connection reads the message again";
    EXPECT_EQ(message.bytes, "one");
}

TEST_F(NmlNetTest, RubbishAndHalfMessagesEndTheirConnectionAndHarmNobodyElse) {
    start();
    const auto command = client("cmd");
    ASSERT_TRUE(command.has_value());
    std::mt19937 random(3);
    const std::string good =
        to_wire({Operation::WRITE, Status::REQUEST, 1, 1, 0, 0, mdi(vocabulary_, "G0 X1")});
    for (int i = 0; i < 60; ++i) {
        std::string bytes = good;
        for (auto changes = random() % 4; changes > 0; --changes) {
            bytes[random() % bytes.size()] = static_cast<char>(random());
        }
        const auto socket = connect_to("127.0.0.1", server_->tcp_port(), Transport::TCP, Deadline({5.0}));
        ASSERT_TRUE(socket.has_value()) << socket.error().str();
        static_cast<void>(
            socket->send(std::string_view(bytes).substr(0, random() % (bytes.size() + 1)), Deadline({5.0})));
    }
    ASSERT_TRUE((*command)->clear({5.0}).has_value());
    EXPECT_TRUE((*command)->write(mdi(vocabulary_, "G0 X9"), {5.0}).has_value());
}

TEST_F(NmlNetTest, ARequestOfAClientThatHasGivenUpIsNotCarriedOut) {
    start();
    {
        const auto socket = connect_to("127.0.0.1", server_->tcp_port(), Transport::TCP, Deadline({5.0}));
        ASSERT_TRUE(socket.has_value()) << socket.error().str();
        const int on = 1;  // sends the bytes together with the end of the connection
        ASSERT_EQ(::setsockopt(socket->fd(), IPPROTO_TCP, TCP_CORK, &on, sizeof on), 0);
        const std::string request =
            to_wire({Operation::WRITE, Status::REQUEST, 1, 1, 0, 0, mdi(vocabulary_, "G0 X1")});
        ASSERT_TRUE(socket->send(request, Deadline({5.0})).has_value());
    }
    Received message;
    EXPECT_FALSE(cmd_->wait(message, {0.5}).value()) << "the machine must not move later";
    const auto command = client("cmd");
    ASSERT_TRUE(command.has_value());
    EXPECT_TRUE((*command)->write(mdi(vocabulary_, "G0 X2"), {5.0}).has_value());
    EXPECT_TRUE(cmd_->wait(message, {5.0}).value());
    EXPECT_EQ(message.bytes, mdi(vocabulary_, "G0 X2"));
}

TEST_F(NmlNetTest, AClientThatIsKilledHarmsNobodyElse) {
    start();
    const auto status = client("sts");
    ASSERT_TRUE(status.has_value());
    for (int round = 0; round < 20; ++round) {
        int ready[2];
        ASSERT_EQ(::pipe(ready), 0);
        const pid_t pid = ::fork();
        if (pid == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            auto mine = client("cmd");
            const char open = 1;
            const std::string bytes = mine.has_value() ? mdi(vocabulary_, std::string(500, 'x')) : "";
            while (mine.has_value() && (*mine)->write(bytes, FOREVER).has_value() &&
                   ::write(ready[1], &open, 1) == 1) {
            }
            ::_exit(1);
        }
        char open = 0;
        ASSERT_EQ(::read(ready[0], &open, 1), 1);
        ::kill(pid, SIGKILL);
        ASSERT_EQ(::waitpid(pid, nullptr, 0), pid);
        ::close(ready[0]);
        ::close(ready[1]);
        Received message;
        for (bool is_more = true; is_more;) {
            is_more = cmd_->read(message, {5.0}).value();
            ASSERT_TRUE(!is_more || Codec(vocabulary_, Encoding::XDR).decode(message.bytes).has_value());
        }
    }
    ASSERT_TRUE(sts_->write("still", AT_ONCE).has_value());
    Received message;
    EXPECT_TRUE((*status)->read(message, {5.0}).value());
}

TEST_F(NmlNetTest, MoreClientsThanAServerCanHaveAreTold) {
    start();
    std::vector<std::unique_ptr<Buffer>> clients;
    Received message;
    for (std::size_t i = 0; i < MAX_SESSIONS; ++i) {
        auto one = client("sts");
        ASSERT_TRUE(one.has_value());
        ASSERT_TRUE((*one)->peek(message, {5.0}).has_value());
        clients.push_back(std::move(*one));
    }
    auto one = client("sts");
    ASSERT_TRUE(one.has_value());
    EXPECT_FALSE((*one)->peek(message, {5.0}).has_value());
    clients.clear();
}

TEST_F(NmlNetTest, ARemoteProcessNeedsAPortInItsBuffer) {
    start();
    config_.buffers[0].tcp_port.reset();
    EXPECT_EQ(client("cmd").error().str(), "net.nml:5:1: buffer 'cmd': process 'gui' is REMOTE, but the "
                                           "buffer has no port (add TCP=PORT to its B line)");
    EXPECT_EQ(client("missing").error().message, "the NML configuration has no B line for buffer 'missing'");
}

}  // namespace
}  // namespace mw::nml
