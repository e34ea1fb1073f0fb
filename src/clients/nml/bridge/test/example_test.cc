// SPDX-License-Identifier: GPL-2.0-or-later
// The example of docs/reference/nml.md, word by word.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "base/diagnostics/sink.hh"
#include "clients/nml/bridge/channel.hh"
#include "clients/nml/config/config_file.hh"
#include "emc_io_generic.hh"

namespace mw::nml {
namespace {

// clang-format off
// begin of the sender
Result<WriteNumber> send_generic(Channel &channel, int index, double value) {
    CommandMessage<messages::EmcIoGeneric> command{{}, {index, value}};
    return channel.write(view(command));
}
// end of the sender

// begin of the receiver
Result<> receive_generic(Channel &channel, std::vector<double> &outputs) {
    auto message = channel.read();
    if (!message.has_value()) {
        return std::unexpected(message.error());
    }
    if (!message->has_value()) {
        return {};  // nothing new
    }
    if (const auto *generic = (*message)->get<messages::EmcIoGeneric>()) {
        const auto allowed = messages::check(messages::object(*generic));
        if (!allowed.has_value()) {
            return allowed;
        }
        outputs[static_cast<std::size_t>(generic->index)] = generic->value;
    }
    return {};
}
// end of the receiver

constexpr const char *EXAMPLE_CONFIG =
// begin of the configuration
R"(B ioGeneric LOCMEM localhost 1024 0 0 20 4 2001 queue xdr serial
P gui       ioGeneric LOCAL localhost W 0 1.0 0 0
P io        ioGeneric LOCAL localhost R 0 1.0 1 1
)";
// end of the configuration
// clang-format on

TEST(NmlExample, AMessageAddedInOnePlaceIsSentAndDoesItsWork) {
    diagnostics::Sink sink;
    const Config config = parse_config(EXAMPLE_CONFIG, "io.nml", sink);
    ASSERT_TRUE(sink.all().empty());
    // clang-format off
    // begin of the connection
    Vocabulary vocabulary = Vocabulary::standard();
    vocabulary.add<messages::EmcIoGeneric>(Base::COMMAND, "EMC_IO_GENERIC_TYPE").value();
    LocalPlaces local;
    auto io = Channel::open({config, "io", "my-machine", vocabulary, local}, "ioGeneric");
    auto gui = Channel::open({config, "gui", "my-machine", vocabulary, local}, "ioGeneric");
    // end of the connection
    // clang-format on
    ASSERT_TRUE(io.has_value() && gui.has_value());
    std::vector<double> outputs(16);
    EXPECT_EQ(send_generic(*gui, 3, 1.5).value(), 1U);
    EXPECT_EQ(send_generic(*gui, 7, -2).value(), 2U) << "the serial number";
    EXPECT_EQ(send_generic(*gui, 16, 1).value(), 3U);
    ASSERT_TRUE(receive_generic(*io, outputs).has_value());
    ASSERT_TRUE(receive_generic(*io, outputs).has_value());
    EXPECT_EQ(outputs[3], 1.5);
    EXPECT_EQ(outputs[7], -2);
    EXPECT_EQ(receive_generic(*io, outputs).error().message, "EmcIoGeneric: index is 16, allowed is 0 to 15");
    EXPECT_TRUE(receive_generic(*io, outputs).has_value()) << "nothing new";
    EXPECT_EQ(vocabulary.find(1605)->name(), std::string("EMC_IO_GENERIC_TYPE"));
}

TEST(NmlExample, EveryMessageIsWrittenInEachEncodingToo) {
    Vocabulary vocabulary = Vocabulary::standard();
    ASSERT_TRUE(vocabulary.add<messages::EmcIoGeneric>(Base::COMMAND, "EMC_IO_GENERIC_TYPE").has_value());
    for (const Encoding encoding : ALL_ENCODINGS) {
        const Codec codec(vocabulary, encoding);
        CommandMessage<messages::EmcIoGeneric> command{{5}, {3, 1.5}};
        std::string bytes;
        ASSERT_TRUE(codec.encode(view(command), bytes).has_value());
        auto read = codec.decode(bytes);
        ASSERT_TRUE(read.has_value());
        EXPECT_EQ(read->get<messages::EmcIoGeneric>()->value, 1.5);
        EXPECT_EQ(read->command_head()->serial_number, 5U);
    }
}

TEST(NmlExample, ThePageShowsWhatIsCompiledHere) {
    const std::string source =
        read_file(MW_SOURCE_DIR "/examples/nml_client/emc_io_generic.hh").value() +
        read_file(MW_SOURCE_DIR "/src/clients/nml/bridge/test/example_test.cc").value();
    const std::string page = read_file(MW_SOURCE_DIR "/docs/reference/nml.md").value();
    for (const std::string part : {"declaration", "sender", "receiver", "configuration", "connection"}) {
        const std::string begin = "// begin of the " + part + "\n", end = "// end of the " + part + "\n";
        const std::size_t from = source.find(begin) + begin.size();
        std::string example = source.substr(from, source.find(end) - from);
        example = example.substr(0, example.find_last_of('\n') + 1);
        ASSERT_GT(example.size(), 100U) << part;
        if (part == "configuration") {
            example = example.substr(3, example.rfind(")\"") - 3);
        }
        EXPECT_NE(page.find(example), std::string::npos) << part << '\n' << example;
    }
}

}  // namespace
}  // namespace mw::nml
