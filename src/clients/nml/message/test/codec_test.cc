// SPDX-License-Identifier: GPL-2.0-or-later
// Tests every message in every encoding.
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "clients/nml/message/codec.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/json.hh"
#include "messages/declarations/status.hh"
#include "messages/declarations/value.hh"

namespace mw::nml {
namespace {

using messages::Kind;

constexpr double ENDLESS = std::numeric_limits<double>::infinity();

/// Writes other values to every field, without using the encodings.
class Scrambler {
  public:
    explicit Scrambler(unsigned seed) : random_(seed) {}

    void fill(const messages::Object &object) {
        for (const messages::Field &field : object.declaration->fields) {
            void *at = field.at(object.data);
            if (field.type.list != nullptr) {
                field.type.list->resize(at, random_() % 4);
            }
            for (std::size_t i = 0; i < messages::count_elements(field.type, at); ++i) {
                fill(field, messages::element(field.type, at, i));
            }
        }
    }

  private:
    std::int64_t bits(unsigned count) {
        const std::uint64_t all = static_cast<std::uint64_t>(random_()) << 32U | random_();
        return count == 64 ? static_cast<std::int64_t>(all)
                           : static_cast<std::int64_t>(all & ((std::uint64_t{1} << count) - 1));
    }
    void fill(const messages::Field &field, void *at) {
        const messages::Type &type = field.type;
        const unsigned width = 8U * type.bytes;
        constexpr std::array SPECIAL{0.0, -0.0, ENDLESS, -ENDLESS, 5e-324, 1.7976931348623157e308, 1.0 / 3};
        switch (type.kind) {
        case Kind::BOOL: messages::set_integer(type, at, static_cast<int>(random_() % 2)); break;
        case Kind::NAMED:
            messages::set_integer(type, at, type.names[random_() % type.names.size()].value);
            break;
        case Kind::INTEGER:
            messages::set_integer(type, at,
                                  width == 64 ? bits(64) : bits(width) - (std::int64_t{1} << (width - 1)));
            break;
        case Kind::UNSIGNED: messages::set_integer(type, at, bits(width)); break;
        case Kind::REAL:
            messages::set_real(at, random_() % 3 == 0 ? SPECIAL[random_() % SPECIAL.size()]
                                                      : std::ldexp(static_cast<double>(bits(53)),
                                                                   static_cast<int>(random_() % 100) - 80));
            break;
        case Kind::TEXT:
        case Kind::FIXED_TEXT: {
            std::string text;
            for (std::size_t left = random_() % 40; left > 0; --left) {
                text += static_cast<char>(random_());  // quotes, backslashes, newlines, zero bytes: all bytes
            }
            ASSERT_TRUE(messages::set_text(type, at, text));
            break;
        }
        case Kind::PARTS: fill({type.parts, at}); break;
        }
    }
    std::mt19937 random_;
};

/// Values read through the declarations, without using the encodings.
std::string values_of(Message &message) {
    const MessageView view = message.view();
    std::string all;
    for (const messages::Object &part : {view.head, view.body}) {
        all += messages::to_json(part);
    }
    return all;
}

TEST(NmlCodec, EveryMessageComesBackFromEveryEncodingAsItWas) {
    const Vocabulary vocabulary = Vocabulary::standard();
    for (unsigned seed = 1; seed <= 10; ++seed) {
        Scrambler scrambler(seed);
        for (const auto &[number, kind] : vocabulary.kinds()) {
            Message message = *vocabulary.make(number);
            scrambler.fill(message.view().head);
            scrambler.fill(message.view().body);
            const std::string values = values_of(message);
            for (const Encoding encoding : ALL_ENCODINGS) {
                const Codec codec(vocabulary, encoding);
                std::string bytes = "before";
                const auto written = codec.encode(message.view(), bytes);
                ASSERT_TRUE(written.has_value()) << written.error().str();
                ASSERT_TRUE(bytes.starts_with("before"));
                auto read = codec.decode(std::string_view(bytes).substr(6));
                ASSERT_TRUE(read.has_value())
                    << kind.name() << ' ' << name_of(encoding) << ": " << read.error().str() << '\n'
                    << bytes;
                EXPECT_EQ(read->number(), number);
                EXPECT_EQ(values_of(*read), values) << kind.name() << ' ' << name_of(encoding);
            }
        }
    }
}

TEST(NmlCodec, XdrIsThatOfItsStandard) {
    const Vocabulary vocabulary = Vocabulary::standard();
    CommandMessage<messages::JogIncrement> jog{{7}, {true, 2, -1.5, 0.25}};
    std::string bytes;
    ASSERT_TRUE(Codec(vocabulary, Encoding::XDR).encode(view(jog), bytes).has_value());
    ASSERT_GT(bytes.size(), 12U);
    EXPECT_EQ(bytes.substr(0, 4), std::string("\0\0\0\x7d", 4));
    EXPECT_EQ(bytes.substr(8), std::string("\0\0\0\x20"            // 32 bytes follow
                                           "\0\0\0\0\0\0\0\x07"    // hyper
                                           "\0\0\0\x01"            // bool
                                           "\0\0\0\x02"            // int
                                           "\xbf\xf8\0\0\0\0\0\0"  // double
                                           "\x3f\xd0\0\0\0\0\0\0",
                                           36));
    CommandMessage<messages::Mdi> mdi{{1}, {"G0 X1"}};
    bytes.clear();
    ASSERT_TRUE(Codec(vocabulary, Encoding::XDR).encode(view(mdi), bytes).has_value());
    EXPECT_EQ(bytes.substr(20), std::string("\0\0\0\x05G0 X1\0\0\0", 12)) << "filled up to four";
}

TEST(NmlCodec, RawIsPackedInTheOrderOfTheFields) {
    const Vocabulary vocabulary = Vocabulary::standard();
    CommandMessage<messages::JogStop> stop{{0x0102}, {true, 5}};
    std::string bytes;
    ASSERT_TRUE(Codec(vocabulary, Encoding::RAW).encode(view(stop), bytes).has_value());
    EXPECT_EQ(bytes.size(), 12U + 8 + 1 + 4);
    std::uint64_t serial = 0;
    std::memcpy(&serial, bytes.data() + 12, sizeof serial);
    EXPECT_EQ(serial, 0x0102U);
}

TEST(NmlCodec, AsciiAndDisplayCanBeReadByPeople) {
    const Vocabulary vocabulary = Vocabulary::standard();
    StatusMessage<messages::IoStatus> io{{122, 9, CommandState::DONE, {}}, {}};
    std::string bytes;
    ASSERT_TRUE(Codec(vocabulary, Encoding::DISPLAY).encode(view(io), bytes).has_value());
    std::string recent;
    for (std::size_t i = 0; i < RECENT_COMMANDS; ++i) {
        const std::string name = "recent[" + std::to_string(i) + "].";
        recent += name + "serial_number=0\n" + name + "state=UNKNOWN\n" + name + "reason=\"\"\n";
    }
    EXPECT_EQ(
        bytes,
        "EMC_IO_STAT_TYPE 1699\ncommand_type=122\necho_serial_number=9\nstate=DONE\nreason=\"\"\n" + recent +
            "aux.estop_requested=1\naux.chain_closed=0\ncoolant.mist=0\ncoolant.flood=0\nlube.on=0\nlube."
            "level_ok=1\n");
    CommandMessage<messages::Mdi> mdi{{3}, {"G0 (\"a\\b\")\n"}};
    bytes.clear();
    ASSERT_TRUE(Codec(vocabulary, Encoding::ASCII).encode(view(mdi), bytes).has_value());
    EXPECT_TRUE(bytes.starts_with("509,")) << bytes;
    EXPECT_TRUE(bytes.ends_with(",3,\"G0 (\\\"a\\\\b\\\")\\x0a\"\n")) << bytes;
    CommandMessage<messages::SetTeleopVector> vector{{1}, {}};
    vector.body.velocity[2] = 1.5;
    bytes.clear();
    ASSERT_TRUE(Codec(vocabulary, Encoding::DISPLAY).encode(view(vector), bytes).has_value());
    EXPECT_NE(bytes.find("\nvelocity[2]=1.5\n"), std::string::npos) << bytes;
}

TEST(NmlCodec, CutLengthenedAndChangedBytesAreErrorsOrOtherMessagesAndNothingElse) {
    const Vocabulary vocabulary = Vocabulary::standard();
    std::mt19937 random(1);
    for (const Encoding encoding : ALL_ENCODINGS) {
        const Codec codec(vocabulary, encoding);
        for (const int number : {506, 125, 1699, 3011}) {
            Message message = *vocabulary.make(number);
            Scrambler(5).fill(message.view().body);
            std::string good;
            ASSERT_TRUE(codec.encode(message.view(), good).has_value());
            for (std::size_t size = 0; size < good.size(); ++size) {
                EXPECT_FALSE(codec.decode(std::string_view(good).substr(0, size)).has_value())
                    << name_of(encoding) << ' ' << number << ' ' << size;
            }
            EXPECT_FALSE(codec.decode(good + '\0').has_value());
            for (int i = 0; i < 2000; ++i) {
                std::string bad = good;
                bad[random() % bad.size()] = static_cast<char>(random());
                auto read = codec.decode(bad);
                if (read.has_value()) {  // another valid message must be decoded, too
                    std::string again;
                    ASSERT_TRUE(codec.encode(read->view(), again).has_value());
                    auto second = codec.decode(again);
                    ASSERT_TRUE(second.has_value()) << second.error().str();
                    EXPECT_EQ(values_of(*second), values_of(*read));
                }
            }
        }
    }
}

TEST(NmlCodec, WhoeverDeclaresAMessageOtherwiseIsToldSo) {
    const Vocabulary vocabulary = Vocabulary::standard();
    const Codec codec(vocabulary, Encoding::XDR);
    CommandMessage<messages::JogStop> stop{{1}, {true, 5}};
    std::string bytes;
    ASSERT_TRUE(codec.encode(view(stop), bytes).has_value());
    bytes[5] = static_cast<char>(bytes[5] + 1);
    EXPECT_EQ(codec.decode(bytes).error().message, "the sender of message 136 declares JogStop differently");
    EXPECT_EQ(codec.decode("").error().message, "the bytes are too few for a message");
    CommandMessage<messages::Mdi> mdi;
    bytes[5] = static_cast<char>(bytes[5] - 1);
    EXPECT_EQ(codec.decode(bytes, view(mdi)).error().message,
              "message 136 (JogStop) came where 509 (Mdi) was expected");
    EXPECT_EQ(codec.decode(std::string("\0\0\x10\0\0\0\0\0\0\0\0\0", 12)).error().message,
              "there is no message 4096");
}

TEST(NmlCodec, ALengthThatLiesTakesNoMemory) {
    const Vocabulary vocabulary = Vocabulary::standard();
    StatusMessage<messages::ToolTable> table;
    std::string bytes;
    for (const Encoding encoding : {Encoding::RAW, Encoding::XDR}) {
        bytes.clear();
        ASSERT_TRUE(Codec(vocabulary, encoding).encode(view(table), bytes).has_value());
        bytes.replace(bytes.size() - 4, 4, 4, '\x7f');
        EXPECT_NE(Codec(vocabulary, encoding).decode(bytes).error().message.find("ends within it"),
                  std::string::npos);
    }
    EXPECT_TRUE(table.body.tools.empty());
}

TEST(NmlCodec, AMessageWithTheHeadOfAnotherClassIsNotWritten) {
    const Vocabulary vocabulary = Vocabulary::standard();
    StatusHead head;
    messages::Mdi body;
    std::string bytes = "x";
    EXPECT_EQ(Codec(vocabulary, Encoding::RAW).encode(view(head, body), bytes).error().message,
              "Mdi is a command and has no StatusHead");
    EXPECT_EQ(bytes, "x");
}

}  // namespace
}  // namespace mw::nml
