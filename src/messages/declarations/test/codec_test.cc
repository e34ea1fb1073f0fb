// SPDX-License-Identifier: GPL-2.0-or-later
// Binary, JSON and text forms: round trips, literal bytes, and rejected input.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "messages/declarations/binary.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/declarations/json.hh"
#include "messages/declarations/status.hh"
#include "messages/declarations/text.hh"
#include "messages/declarations/value.hh"

namespace mw::messages {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/// Fills every field with a value within its declared range.
class Filler {
  public:
    explicit Filler(unsigned seed) : random_(seed) {}

    void fill(const Object &object) {
        for (const Field &field : object.declaration->fields) {
            void *at = field.at(object.data);
            if (field.type.list != nullptr) {
                field.type.list->resize(at, 3);
            }
            for (std::size_t i = 0; i < count_elements(field.type, at); ++i) {
                fill_element(field, element(field.type, at, i));
            }
        }
    }

  private:
    double within(Range range) {
        const double low = std::max(range.min, -1e6), high = std::min(range.max, 1e6);
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    void fill_element(const Field &field, void *at) {
        const Type &type = field.type;
        switch (type.kind) {
        case Kind::BOOL: set_integer(type, at, static_cast<int>(random_() % 2)); break;
        case Kind::NAMED: set_integer(type, at, type.names[random_() % type.names.size()].value); break;
        case Kind::INTEGER: set_integer(type, at, std::llround(within(field.range))); break;
        case Kind::UNSIGNED:
            set_integer(type, at,
                        std::llround(std::fabs(within(field.range))) & (type.bytes == 1 ? 0xff : -1));
            break;
        case Kind::REAL: set_real(at, within(field.range)); break;
        case Kind::TEXT:
        case Kind::FIXED_TEXT: {
            std::string text = "x \"\\\n\xc3\xa4";
            text.resize(text.size() + random_() % 20, 'y');
            EXPECT_TRUE(set_text(type, at, text));
            break;
        }
        case Kind::PARTS: fill({type.parts, at}); break;
        }
    }
    std::mt19937 random_;
};

TEST(Codec, EveryCommandComesBackFromBytesAndJsonAsItWas) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        Filler filler(seed);
        for (const Declaration *d : command_declarations()) {
            Command command = *make_command(d->number);
            filler.fill(object(command));
            ASSERT_TRUE(check(command).has_value()) << check(command).error().str();
            const std::string bytes = encode(command), json = to_json(command), text = to_text(command);
            const auto from_bytes = decode_command(bytes);
            ASSERT_TRUE(from_bytes.has_value()) << from_bytes.error().str();
            EXPECT_EQ(encode(*from_bytes), bytes) << json;
            const auto read = command_from_json(json);
            ASSERT_TRUE(read.has_value()) << json << read.error().str();
            EXPECT_EQ(encode(*read), bytes) << json;
            EXPECT_EQ(text.find('\n'), std::string::npos) << text;
            EXPECT_EQ(text.substr(0, text.find(' ')), d->name);
        }
    }
}

TEST(Codec, AStatusComesBackAsItWasWithInfiniteLimits) {
    auto status = std::make_unique<MachineStatus>(), again = std::make_unique<MachineStatus>();
    Filler(7).fill(object(*status));
    status->joints[2].max_limit = INFINITE;
    status->joints[2].min_limit = -INFINITE;
    status->axes[8].velocity = std::nan("");
    std::string bytes, second;
    encode(object(*status), bytes);
    ASSERT_TRUE(decode(bytes, object(*again)).has_value());
    encode(object(*again), second);
    EXPECT_EQ(bytes, second);
    const std::string json = to_json(object(*status));
    *again = {};
    const auto read = from_json(json, object(*again));
    ASSERT_TRUE(read.has_value()) << read.error().str();
    EXPECT_EQ(to_json(object(*again)), json);
    EXPECT_EQ(again->joints[2].max_limit, INFINITE);
    EXPECT_TRUE(std::isnan(again->axes[8].velocity));
}

TEST(Codec, AToolTableOfAnyLengthComesBack) {
    ToolTable table{9, {{1, 2, {}, 3.5, 0, 0, 4, "a"}, {5, 6, {}, 7.5, 1, 2, 3, ""}}}, again;
    std::string bytes;
    encode(object(table), bytes);
    ASSERT_TRUE(decode(bytes, object(again)).has_value());
    ASSERT_EQ(again.tools.size(), 2U);
    EXPECT_EQ(again.tools[0].comment, "a");
    EXPECT_EQ(again.tools[1].orientation, 3);
    ToolTable third;
    ASSERT_TRUE(from_json(to_json(object(table)), object(third)).has_value());
    EXPECT_EQ(third.tools[1].diameter, 7.5);
}

TEST(Codec, BytesAreTheWrittenFormat) {
    const std::string bytes = encode(JogStop{true, 0x0102});
    EXPECT_EQ(bytes, std::string("MW\x01\0\x88\0\x05\0\0\0\x01\x02\x01\0\0", 15));
    EXPECT_EQ(encode(Mdi{"G0"}), std::string("MW\x01\0\xfd\x01\x06\0\0\0\x02\0\0\0G0", 16));
    EXPECT_EQ(to_json(JogStop{false, 3}), R"({"message":"JogStop","is_joint":false,"index":3})");
    EXPECT_EQ(to_text(SetState{State::ON}), "SetState state=ON");
    EXPECT_EQ(to_text(Mdi{"G0\n\"x\""}), R"(Mdi line="G0\x0a\"x\"")");
}

TEST(Codec, NoChangedCutOrLengthenedBytesAreTakenForWhatTheyAreNot) {
    const std::string good = encode(JogIncrement{true, 3, 5.0, 2.5});
    for (std::size_t size = 0; size < good.size(); ++size) {
        EXPECT_FALSE(decode_command(good.substr(0, size)).has_value()) << size;
    }
    EXPECT_FALSE(decode_command(good + '\0').has_value());
    std::string longer = good + '\0';
    ++longer[6];  // the length is correct
    EXPECT_NE(decode_command(longer).error().message.find("too many"), std::string::npos);
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            std::string bad = good;
            bad[i] = static_cast<char>(bad[i] ^ (1 << bit));
            const auto command = decode_command(bad);
            EXPECT_TRUE(!command.has_value() || encode(*command) == bad) << i << ' ' << bit;
        }
    }
    std::string version = good;
    version[2] = 2;
    EXPECT_EQ(decode_command(version).error().message, "the message has version 2, this program has 1");
}

TEST(Codec, ALengthThatLiesTakesNoMemory) {
    std::string text = encode(Mdi{"G0"});
    text[13] = 0x7f;  // the text claims a length of two thousand million bytes
    EXPECT_FALSE(decode_command(text).has_value());
    ToolTable table;
    std::string bytes;
    encode(object(table), bytes);
    bytes[bytes.size() - 1] = 0x7f;
    EXPECT_NE(decode(bytes, object(table)).error().message.find("more than it may have"), std::string::npos);
}

TEST(Codec, WrongJsonIsRefusedWithItsField) {
    const auto refused = [](const char *json) {
        const auto command = command_from_json(json);
        return command.has_value() ? "taken: " + to_text(*command) : command.error().message;
    };
    EXPECT_EQ(refused("{"), "this is no JSON object");
    EXPECT_EQ(refused("[]"), "this is no JSON object");
    EXPECT_EQ(refused("{}"), "the JSON object has no text 'message'");
    EXPECT_EQ(refused(R"({"message":"Jig"})"), "there is no command 'Jig'");
    EXPECT_EQ(refused(R"({"message":"JogStop","is_joint":true})"), "JogStop: index is missing");
    EXPECT_EQ(refused(R"({"message":"JogStop","is_joint":1,"index":0})"),
              "JogStop: is_joint must be true or false");
    EXPECT_EQ(refused(R"({"message":"JogStop","is_joint":true,"index":1.5})"),
              "JogStop: index must be a whole number");
    EXPECT_EQ(refused(R"({"message":"JogStop","is_joint":true,"index":1e30})"),
              "JogStop: index must be a whole number");
    EXPECT_EQ(refused(R"({"message":"JogStop","is_joint":true,"index":4294967296})"),
              "JogStop: index is 4294967296, which is out of its range");
    EXPECT_EQ(refused(R"({"message":"JogStop","is_joint":true,"index":0,"speed":1})"),
              "JogStop: there is no field 'speed'");
    EXPECT_EQ(refused(R"({"message":"SetState","state":"RUNNING"})"),
              "SetState: state must be one of ESTOP, ESTOP_RESET, OFF, ON");
    EXPECT_EQ(refused(R"({"message":"SetFeedOverride","factor":"inf"})"),
              "SetFeedOverride: factor is inf, allowed is at least 0 [1.0 is 100 %]");
    EXPECT_EQ(refused(R"({"message":"SetTeleopVector","velocity":[0,0]})"),
              "SetTeleopVector: velocity must have 9 entries");
    EXPECT_EQ(refused(R"({"message":"RunProgram"})"), "taken: RunProgram from_line=0");
}

TEST(Codec, DeeplyNestedJsonIsAnErrorAndNoCrash) {
    EXPECT_FALSE(command_from_json(std::string(200000, '[')).has_value());
    EXPECT_FALSE(command_from_json(R"({"message":"Mdi","line":)" + std::string(200000, '[')).has_value());
}

}  // namespace
}  // namespace mw::messages
