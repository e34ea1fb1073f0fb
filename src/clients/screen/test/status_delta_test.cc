// SPDX-License-Identifier: GPL-2.0-or-later
// Tests that a browser can reconstruct the status from the deltas (J3).
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include <gtest/gtest.h>

#include "clients/screen/status/status_delta.hh"
#include "messages/declarations/json.hh"
#include "messages/declarations/value.hh"

namespace mw::screen {
namespace {

using Json = nlohmann::json;
using Random = std::mt19937_64;

/// Merges as docs/reference/api.md describes it for browsers.
void merge(Json &into, const Json &delta) {
    for (const auto &[key, value] : delta.items()) {
        if (into.is_array()) {
            const std::size_t index = std::stoul(key);
            ASSERT_LT(index, into.size());
            value.is_object() ? merge(into[index], value) : void(into[index] = value);
        } else {
            ASSERT_TRUE(into.contains(key)) << key;
            value.is_object() ? merge(into[key], value) : void(into[key] = value);
        }
    }
}

void change_value(const messages::Type &type, void *at, Random &random);

/// Changes each field with a probability of one in `rarely`.
void change(const messages::Declaration &declaration, void *object, Random &random, unsigned rarely) {
    for (const messages::Field &field : declaration.fields) {
        void *at = field.at(object);
        const std::size_t count = messages::count_elements(field.type, at);
        for (std::size_t i = 0; i < count; ++i) {
            void *one = messages::isSeries(field.type) ? messages::element(field.type, at, i) : at;
            if (field.type.kind == messages::Kind::PARTS) {
                change(*field.type.parts, one, random, rarely);
            } else if (random() % rarely == 0) {
                change_value(field.type, one, random);
            }
        }
    }
}

void change_value(const messages::Type &type, void *at, Random &random) {
    constexpr double REALS[] = {0.0, -0.0, 1e300, std::numeric_limits<double>::infinity(), 0.1};
    switch (type.kind) {
    case messages::Kind::BOOL:
        messages::set_integer(type, at, static_cast<std::int64_t>(random() % 2));
        return;
    case messages::Kind::NAMED:
        messages::set_integer(type, at, type.names[random() % type.names.size()].value);
        return;
    case messages::Kind::INTEGER:
    case messages::Kind::UNSIGNED:
        messages::set_integer(type, at, static_cast<std::int64_t>(random() % 100));
        return;
    case messages::Kind::REAL:
        messages::set_real(at, random() % 4 == 0    ? REALS[random() % std::size(REALS)]
                               : random() % 50 == 0 ? std::nan("")
                                                    : static_cast<double>(random() % 1000000) / 1e3);
        return;
    case messages::Kind::TEXT:
    case messages::Kind::FIXED_TEXT: {
        const std::string_view texts[] = {"", "a \"quoted\" name\n", "/päth/ü.ngc", "\xff\xfe"};
        ASSERT_TRUE(messages::set_text(type, at, texts[random() % std::size(texts)]));
        return;
    }
    case messages::Kind::PARTS: return;
    }
}

Json whole_of(const messages::MachineStatus &status) {
    return Json::parse(messages::to_json(messages::object(status)));
}

TEST(StatusDelta, ThePiecesOfManyChangesMakeTheWhole) {
    const auto &declaration = messages::DECLARATION<messages::MachineStatus>;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        auto status = std::make_unique<messages::MachineStatus>();
        change(declaration, status.get(), random, 2);
        StatusDelta delta;
        Json seen = Json::parse(delta.whole(*status));
        for (int step = 0; step < 30; ++step) {
            change(declaration, status.get(), random, 1U << random() % 10);
            const std::string text = delta.next(*status);
            if (!text.empty()) {
                merge(seen, Json::parse(text));
            }
            ASSERT_EQ(seen.dump(-1, ' ', false, Json::error_handler_t::replace), whole_of(*status).dump())
                << "seed " << seed << " step " << step;
        }
    }
}

TEST(StatusDelta, PartsThatWereReadAreEnough) {
    const auto &declaration = messages::DECLARATION<messages::MachineStatus>;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        auto published = std::make_unique<messages::PublishedStatus>();
        auto copy = std::make_unique<messages::PublishedStatus::Copy>();
        auto status = std::make_unique<messages::MachineStatus>();
        published->write(*status);
        ASSERT_TRUE(published->read(*copy));
        StatusDelta delta;
        Json seen = Json::parse(delta.whole(copy->value));
        PartMask unread = 0;
        for (int step = 0; step < 60; ++step) {
            change(declaration, status.get(), random, 1U << random() % 10);
            published->write(*status, published->changed(*status, messages::PublishedStatus::ALL));
            if (random() % 3 == 0) {
                continue;  // the part is read later
            }
            ASSERT_TRUE(published->read(*copy));
            unread |= copy->fresh;
            if (random() % 3 == 0) {
                continue;  // the change is sent later
            }
            const std::string text = delta.next(copy->value, unread);
            unread = 0;
            if (!text.empty()) {
                merge(seen, Json::parse(text));
            }
            ASSERT_EQ(seen, whole_of(*status)) << "seed " << seed << " step " << step;
        }
    }
}

TEST(StatusDelta, OnlyWhatHasChangedIsTold) {
    auto status = std::make_unique<messages::MachineStatus>();
    StatusDelta delta;
    static_cast<void>(delta.whole(*status));
    EXPECT_EQ(delta.next(*status), "");
    status->joints[2].pos_cmd = 4.5;
    status->motion.analog_in[3] = 0.5;
    status->task.program = std::string_view("a.ngc");
    EXPECT_EQ(delta.next(*status), R"({"task":{"program":"a.ngc"},"motion":{"analog_in":{"3":0.5}},)"
                                   R"("joints":{"2":{"pos_cmd":4.5}}})");
    EXPECT_EQ(delta.next(*status), "");
}

}  // namespace
}  // namespace mw::screen
