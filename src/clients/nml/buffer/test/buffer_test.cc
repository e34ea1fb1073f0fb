// SPDX-License-Identifier: GPL-2.0-or-later
// The same tests for all types of buffers, each mutex, with and without queue.
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "base/diagnostics/sink.hh"
#include "clients/nml/buffer/open.hh"
#include "clients/nml/config/config_file.hh"

namespace mw::nml {
namespace {

std::string unique_instance() {
    static int count = 0;
    return "test" + std::to_string(::getpid()) + "_" + std::to_string(++count);
}

/// Buffer b with processes master, reader, writer.
Config config_with(const std::string &kind, const std::string &options, int size = 800,
                   int max_processes = 4) {
    diagnostics::Sink sink;
    Config config =
        parse_config("B b " + kind + " localhost " + std::to_string(size) + " 0 0 1 " +
                         std::to_string(max_processes) + " 77 " + options +
                         "\nP master b LOCAL localhost RW 0 1 1 0\nP reader b LOCAL localhost R 0 1 0 1\n"
                         "P writer b LOCAL localhost W 0 1 0 2\n",
                     "test.nml", sink);
    EXPECT_FALSE(sink.hasErrors());
    return config;
}

class OneBuffer {
  public:
    OneBuffer(const std::string &kind, const std::string &options, int size = 800)
        : folder_(std::filesystem::temp_directory_path() / ("mw_nml_" + unique_instance())) {
        std::filesystem::create_directory(folder_);
        const std::string file = kind == "FILEMEM" ? " file=" + (folder_ / "b").string() : "";
        config_ = config_with(kind, options + file, size);
    }
    OneBuffer(const OneBuffer &) = delete;
    OneBuffer &operator=(const OneBuffer &) = delete;
    ~OneBuffer() { std::filesystem::remove_all(folder_); }

    Result<std::unique_ptr<Buffer>> try_open(const std::string &process) {
        return open_buffer(config_.buffers[0], *config_.find_process(process, "b"), instance_, local_);
    }
    std::unique_ptr<Buffer> open(const std::string &process) {
        auto buffer = try_open(process);
        EXPECT_TRUE(buffer.has_value()) << (buffer.has_value() ? "" : buffer.error().str());
        return buffer.has_value() ? std::move(*buffer) : nullptr;
    }
    Config &config() { return config_; }

  private:
    std::filesystem::path folder_;
    std::string instance_ = unique_instance();
    LocalPlaces local_;
    Config config_;
};

/// Type of buffer and mutex.
class NmlBufferTest : public ::testing::TestWithParam<std::tuple<const char *, const char *>> {
  protected:
    std::string kind() const { return std::get<0>(GetParam()); }
    std::string mutex() const { return std::string("mutex=") + std::get<1>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(All, NmlBufferTest,
                         ::testing::Combine(::testing::Values("SHMEM", "LOCMEM", "FILEMEM"),
                                            ::testing::Values("os_sem", "none", "mao split", "mao split=5",
                                                              "no_interrupts", "no_switching")));

std::string read_one(Buffer &buffer) {
    Received message;
    const auto found = buffer.read(message, AT_ONCE);
    EXPECT_TRUE(found.has_value()) << (found.has_value() ? "" : found.error().str());
    return found.has_value() && *found ? message.bytes : "nothing";
}

std::string peek_one(Buffer &buffer) {
    Received message;
    const auto found = buffer.peek(message, AT_ONCE);
    return found.has_value() && *found ? message.bytes : "nothing";
}

TEST_P(NmlBufferTest, TheNewestMessageIsReadOnceByEachReaderAndSeenByPeekAlways) {
    OneBuffer setup(kind(), mutex());
    const auto a = setup.open("master"), b = setup.open("reader");
    ASSERT_TRUE(a != nullptr && b != nullptr);
    EXPECT_EQ(read_one(*b), "nothing");
    EXPECT_EQ(peek_one(*b), "nothing");
    EXPECT_EQ(a->write("first", AT_ONCE).value(), 1U);
    EXPECT_EQ(a->write("second one", AT_ONCE).value(), 2U);
    EXPECT_EQ(peek_one(*b), "second one");
    EXPECT_EQ(read_one(*b), "second one");
    EXPECT_EQ(read_one(*b), "nothing") << "read already";
    EXPECT_EQ(peek_one(*b), "second one");
    EXPECT_EQ(read_one(*a), "second one") << "each reader for itself";
    ASSERT_TRUE(a->write("", AT_ONCE).has_value());
    EXPECT_EQ(read_one(*b), "") << "an empty message is one";
    ASSERT_TRUE(a->write(std::string(800, 'x'), AT_ONCE).has_value());
    EXPECT_EQ(read_one(*b), std::string(800, 'x'));
    ASSERT_TRUE(a->clear(AT_ONCE).has_value());
    EXPECT_EQ(peek_one(*b), "nothing");
}

TEST_P(NmlBufferTest, AQueueGivesEachMessageOnceInItsOrderWithItsNumber) {
    OneBuffer setup(kind(), mutex() + " queue");
    const auto a = setup.open("master"), b = setup.open("reader");
    ASSERT_TRUE(a != nullptr && b != nullptr);
    for (int round = 0; round < 40; ++round) {  // the queue wraps several times
        for (int i = 0; i < 5; ++i) {
            ASSERT_TRUE(
                a->write(std::string(static_cast<std::size_t>(20 * i + round), 'a'), AT_ONCE).has_value());
        }
        EXPECT_EQ(peek_one(*b).size(), static_cast<std::size_t>(round));
        for (int i = 0; i < 5; ++i) {
            Received message;
            ASSERT_TRUE(b->read(message, AT_ONCE).value());
            EXPECT_EQ(message.bytes, std::string(static_cast<std::size_t>(20 * i + round), 'a'));
            EXPECT_EQ(message.number, static_cast<WriteNumber>(5 * round + i + 1));
        }
        EXPECT_EQ(read_one(*b), "nothing");
    }
}

TEST_P(NmlBufferTest, AFullQueueSaysSoWhenTimeIsOverAndTakesMoreWhenOneWasTakenOut) {
    OneBuffer setup(kind(), mutex() + " queue");
    const auto a = setup.open("master"), b = setup.open("reader");
    ASSERT_TRUE(a != nullptr && b != nullptr);
    int written = 0;
    while (a->write(std::string(84, 'q'), AT_ONCE).has_value()) {  // 104 bytes with the header
        ++written;
    }
    EXPECT_EQ(written, 7);
    EXPECT_EQ(a->write("x", {0.001}).value(), 8U) << "a small one still fits";
    EXPECT_NE(a->write(std::string(84, 'q'), {0.001}).error().message.find("queue is full"),
              std::string::npos);
    std::jthread reader([&b] { read_one(*b); });
    EXPECT_TRUE(a->write(std::string(84, 'q'), FOREVER).has_value());
    reader.join();
    EXPECT_NE(a->write(std::string(801, 'q'), FOREVER).error().message.find("larger than it"),
              std::string::npos);
}

TEST_P(NmlBufferTest, AWaitingReaderWakesForAMessageAndForTheEndOfItsTime) {
    OneBuffer setup(kind(), mutex());
    const auto a = setup.open("master"), b = setup.open("reader");
    ASSERT_TRUE(a != nullptr && b != nullptr);
    Received message;
    EXPECT_FALSE(b->wait(message, {0.002}).value());
    EXPECT_FALSE(b->wait(message, AT_ONCE).value());
    std::jthread writer([&a] { EXPECT_TRUE(a->write("here", FOREVER).has_value()); });
    EXPECT_TRUE(b->wait(message, FOREVER).value());
    EXPECT_EQ(message.bytes, "here");
    writer.join();
    EXPECT_FALSE(b->wait(message, {0.002}).value()) << "read already";
}

TEST_P(NmlBufferTest, AReaderBesideABusyWriterNeverGetsHalfAMessage) {
    OneBuffer setup(kind(), mutex(), 4000);
    const auto a = setup.open("master"), b = setup.open("reader");
    ASSERT_TRUE(a != nullptr && b != nullptr);
    const std::jthread writer([&a](const std::stop_token &end) {
        for (unsigned i = 0; !end.stop_requested(); ++i) {
            const std::string bytes(1 + (i * 37) % 4000, static_cast<char>('a' + i % 26));
            ASSERT_TRUE(a->write(bytes, FOREVER).has_value());
        }
    });
    Received message;
    for (int i = 0; i < 2000; ++i) {
        const auto found = b->wait(message, {10.0});
        ASSERT_TRUE(found.has_value() && *found);
        ASSERT_EQ(message.bytes.find_first_not_of(message.bytes[0]), std::string::npos);
    }
}

TEST(NmlBuffer, RightsAreThoseOfTheProcessLine) {
    OneBuffer setup("SHMEM", "");
    const auto a = setup.open("master"), reader = setup.open("reader"), writer = setup.open("writer");
    ASSERT_TRUE(reader != nullptr && writer != nullptr);
    Received message;
    EXPECT_EQ(reader->write("x", AT_ONCE).error().message, "buffer 'b': this process may not write to it");
    EXPECT_EQ(writer->read(message, AT_ONCE).error().message, "buffer 'b': this process may not read it");
    EXPECT_FALSE(writer->peek(message, AT_ONCE).has_value() || writer->wait(message, AT_ONCE).has_value());
    EXPECT_TRUE(writer->write("x", AT_ONCE).has_value());
    EXPECT_EQ(read_one(*reader), "x");
}

TEST(NmlBuffer, ALocalBufferWithoutItsMasterIsAnErrorThatSaysWhatToDo) {
    for (const char *kind : {"SHMEM", "LOCMEM", "FILEMEM"}) {
        OneBuffer setup(kind, "");
        const auto reader = setup.try_open("reader");
        ASSERT_FALSE(reader.has_value()) << kind;
        EXPECT_NE(reader.error().str().find("master=1"), std::string::npos) << reader.error().str();
    }
}

TEST(NmlBuffer, PhantomTakesEverythingAndGivesNothing) {
    OneBuffer setup("PHANTOM", "");
    const auto a = setup.open("master");
    ASSERT_NE(a, nullptr);
    EXPECT_TRUE(a->write(std::string(100000, 'x'), AT_ONCE).has_value());
    EXPECT_EQ(read_one(*a), "nothing");
    Received message;
    EXPECT_FALSE(a->wait(message, {0.002}).value());
    EXPECT_FALSE(a->wait(message, FOREVER).has_value()) << "it would never end";
}

TEST(NmlBuffer, GlobmemIsRefusedWithTheReason) {
    OneBuffer setup("GLOBMEM", "");
    EXPECT_EQ(setup.try_open("master").error().str(),
              "test.nml:1:1: buffer 'b': GLOBMEM is memory on a backplane that several computers share; "
              "Linux has none "
              "(use SHMEM, and TCP= for other computers)");
}

TEST(NmlBuffer, WaitingForMessagesIsRefusedWhereBsemSaysSo) {
    OneBuffer setup("LOCMEM", "bsem=-1");
    const auto a = setup.open("master");
    ASSERT_NE(a, nullptr);
    Received message;
    EXPECT_NE(a->wait(message, AT_ONCE).error().str().find("bsem=-1"), std::string::npos);
}

TEST(NmlBuffer, DiagnosticsCountWhatEachProcessDoes) {
    OneBuffer setup("LOCMEM", "diag");
    const auto a = setup.open("master"), b = setup.open("reader");
    ASSERT_TRUE(a->write("12345", AT_ONCE).has_value());
    ASSERT_TRUE(a->write("123", AT_ONCE).has_value());
    EXPECT_EQ(read_one(*b), "123");
    const auto figures = a->figures().value();
    ASSERT_EQ(figures.size(), 1U) << "both are of this process";
    EXPECT_EQ(figures[0].pid, ::getpid());
    EXPECT_EQ(figures[0].writes, 2U);
    EXPECT_EQ(figures[0].bytes_written, 8U);
    EXPECT_EQ(figures[0].reads, 1U);
    EXPECT_EQ(figures[0].bytes_read, 3U);
    EXPECT_GT(figures[0].last_access_ns, 0);
    OneBuffer quiet("LOCMEM", "");
    EXPECT_TRUE(quiet.open("master")->figures().value().empty());
}

TEST(NmlBuffer, AFileKeepsItsMessageWhenNobodyUsesIt) {
    OneBuffer setup("FILEMEM", "");
    {
        const auto a = setup.open("master");
        ASSERT_TRUE(a->write("kept", AT_ONCE).has_value());
    }
    const auto b = setup.open("reader");
    ASSERT_NE(b, nullptr);
    EXPECT_EQ(read_one(*b), "kept");
    setup.config().buffers[0].size = 1600;
    EXPECT_NE(setup.try_open("reader").error().message.find("is not a file of this buffer"),
              std::string::npos);
    setup.config().buffers[0].file.clear();
    EXPECT_NE(setup.try_open("master").error().str().find("file=PATH"), std::string::npos);
}

TEST(NmlBuffer, TwoProgramsThatDescribeABufferOtherwiseDoNotShareIt) {
    OneBuffer setup("SHMEM", "");
    const auto a = setup.open("master");
    setup.config().buffers[0].is_queue = true;
    EXPECT_FALSE(setup.try_open("reader").has_value());
}

}  // namespace
}  // namespace mw::nml
