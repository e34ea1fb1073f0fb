// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the folder of offers at a machine: states, repeated messages, interrupted calls, and several
// processes.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/offers/offer_box.hh"

namespace mw::offers {
namespace {

namespace fs = std::filesystem;

constexpr TimeMs NOW = 1'700'000'000'000;
const auto WRITTEN = [](const Offer &) -> Result<> { return {}; };

std::string id_of(int number) {
    std::string id = "00000000-0000-4000-8000-000000000000", text = std::to_string(number);
    return id.replace(id.size() - text.size(), text.size(), text);
}

Offer offer(int number, const std::string &text = "M2\n", int parts = 0) {
    Offer made{.id = id_of(number),
               .from = "Eva",
               .note = "",
               .parts = parts,
               .sha256 = {},
               .files = {{"a.ngc", text}}};
    made.sha256 = sha256_of(made.files);
    return made;
}

class OfferBoxTest : public testing::Test {
  protected:
    OfferBoxTest() {
        std::string name = (fs::temp_directory_path() / "mw-offers-XXXXXX").string();
        EXPECT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
        box_.emplace(OfferBox::open(folder_).value());
    }
    ~OfferBoxTest() override { fs::remove_all(folder_); }

    State state(int number) {
        const auto entries = box_->entries().value();
        for (const Entry &one : entries) {
            if (one.standing.id == id_of(number)) {
                return one.standing.state;
            }
        }
        return State::SENT;
    }
    bool hasText(int number) { return fs::exists(folder_ + '/' + id_of(number) + ".json"); }

    std::string folder_;
    std::optional<OfferBox> box_;
};

TEST_F(OfferBoxTest, KeepsAnOfferUntilThePersonDecides) {
    ASSERT_TRUE(box_->take(offer(1, "M2\n", 5), NOW).has_value());
    box_.emplace(OfferBox::open(folder_).value());
    ASSERT_EQ(box_->read(id_of(1)).value(), offer(1, "M2\n", 5));
    const Entry entry = box_->entries().value().at(0);
    EXPECT_EQ(entry.name, "a.ngc");
    EXPECT_EQ(entry.parts, 5);
    EXPECT_EQ(entry.bytes, 3);
    EXPECT_EQ(report_of({entry}).changes.at(0).state, State::RECEIVED);
    EXPECT_EQ(report_of({entry}).open, std::vector{id_of(1)});
}

TEST_F(OfferBoxTest, AcceptsOnceAndMakesAJob) {
    ASSERT_TRUE(box_->take(offer(1, "M2\n", 5), NOW).has_value());
    int written = 0;
    const auto put = [&written](const Offer &one) -> Result<> {
        EXPECT_EQ(one, offer(1, "M2\n", 5));
        ++written;
        return {};
    };
    ASSERT_TRUE(box_->accept(id_of(1), "Jo", NOW + 1, put).has_value());
    EXPECT_FALSE(box_->accept(id_of(1), "Jo", NOW + 2, put).has_value());
    EXPECT_FALSE(box_->decline(id_of(1), "Jo", "", NOW + 2).has_value());
    EXPECT_EQ(written, 1);
    const Entry entry = box_->entries().value().at(0);
    EXPECT_EQ(entry.standing, (Standing{id_of(1), State::ACCEPTED, NOW + 1, "Jo", ""}));
    EXPECT_TRUE(entry.isJob);
    EXPECT_FALSE(hasText(1));
    EXPECT_TRUE(box_->finish(id_of(1)).has_value());
    EXPECT_FALSE(box_->finish(id_of(1)).has_value());
    EXPECT_FALSE(box_->entries().value().at(0).isJob);
}

TEST_F(OfferBoxTest, WaitsAfterFilesCouldNotBeWritten) {
    ASSERT_TRUE(box_->take(offer(1), NOW).has_value());
    const auto failed =
        box_->accept(id_of(1), "Jo", NOW, [](const Offer &) { return fail("the disk is full"); });
    ASSERT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().message, "the disk is full");
    EXPECT_EQ(state(1), State::RECEIVED);
    EXPECT_TRUE(box_->accept(id_of(1), "Jo", NOW, WRITTEN).has_value());
}

TEST_F(OfferBoxTest, TakesARepeatedOfferOnce) {
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(box_->take(offer(1), NOW).has_value());
    }
    EXPECT_EQ(box_->entries().value().size(), 1);
    const auto other = box_->take(offer(1, "G0 Z-50\nM2\n"), NOW);
    ASSERT_FALSE(other.has_value());
    EXPECT_NE(other.error().message.find("the first ones are kept"), std::string::npos);
    EXPECT_EQ(box_->read(id_of(1)).value(), offer(1));
    ASSERT_TRUE(box_->decline(id_of(1), "Jo", "no stock", NOW).has_value());
    ASSERT_TRUE(box_->take(offer(1), NOW).has_value());
    EXPECT_EQ(state(1), State::DECLINED);
    EXPECT_FALSE(hasText(1));
}

TEST_F(OfferBoxTest, WithdrawsWhatNobodyDecided) {
    ASSERT_TRUE(box_->take(offer(1), NOW).has_value());
    ASSERT_TRUE(box_->take(offer(2), NOW).has_value());
    ASSERT_TRUE(box_->accept(id_of(2), "Jo", NOW, WRITTEN).has_value());
    ASSERT_TRUE(box_->note({{id_of(1), State::RECEIVED}, {id_of(2), State::ACCEPTED}}).has_value());
    ASSERT_TRUE(box_->withdraw({id_of(1), id_of(2), id_of(3)}, NOW).has_value());
    EXPECT_EQ(state(1), State::WITHDRAWN);
    EXPECT_EQ(state(2), State::ACCEPTED);
    EXPECT_EQ(state(3), State::WITHDRAWN);
    EXPECT_EQ(report_of(box_->entries().value()).changes.size(), 3)
        << "the shop hears the truth about all three";
    EXPECT_FALSE(box_->accept(id_of(1), "Jo", NOW, WRITTEN).has_value());
    ASSERT_TRUE(box_->take(offer(3), NOW).has_value()) << "a late copy of a withdrawn offer";
    EXPECT_EQ(state(3), State::WITHDRAWN);
}

TEST_F(OfferBoxTest, HasLimits) {
    for (int i = 0; i < static_cast<int>(OfferBox::MOST_OPEN); ++i) {
        ASSERT_TRUE(box_->take(offer(i), NOW).has_value());
    }
    EXPECT_FALSE(report_of(box_->entries().value()).hasRoom);
    EXPECT_FALSE(box_->take(offer(999), NOW).has_value());
    ASSERT_TRUE(box_->decline(id_of(0), "Jo", "", NOW).has_value());
    EXPECT_TRUE(box_->take(offer(999), NOW).has_value());
    EXPECT_FALSE(box_->decline(id_of(1), "Jo", "a\nb", NOW).has_value());
    EXPECT_FALSE(box_->read("../../etc/passwd").has_value());
}

TEST_F(OfferBoxTest, ForgetsOnlyOldOffersThatTheShopKnows) {
    std::vector<std::string> ids;
    std::vector<Note> notes;
    for (int i = 0; i < static_cast<int>(OfferBox::MOST_ENDED) + 100; ++i) {
        ids.push_back(id_of(i));
        notes.push_back({id_of(i), State::WITHDRAWN});
    }
    ASSERT_TRUE(box_->take(offer(100'000), NOW).has_value());
    ASSERT_TRUE(box_->withdraw(ids, NOW).has_value());
    EXPECT_EQ(box_->entries().value().size(), ids.size() + 1) << "not noted yet";
    ASSERT_TRUE(box_->note(notes).has_value());
    EXPECT_EQ(box_->entries().value().size(), OfferBox::MOST_ENDED + 1);
    EXPECT_EQ(state(100'000), State::RECEIVED);
}

/// A kill between the two files of take() leaves a text without an entry; a kill of accept() an entry that
/// waits.
TEST_F(OfferBoxTest, RemovesTheTextOfAnInterruptedCall) {
    ASSERT_TRUE(write_file_atomically(folder_ + '/' + id_of(7) + ".json", encode(offer(7))).has_value());
    box_.emplace(OfferBox::open(folder_).value());
    EXPECT_FALSE(hasText(7));
    EXPECT_TRUE(box_->take(offer(7), NOW).has_value());
    EXPECT_TRUE(hasText(7));
}

TEST_F(OfferBoxTest, ReportsADamagedIndexAndKeepsIt) {
    ASSERT_TRUE(box_->take(offer(1), NOW).has_value());
    std::ofstream(folder_ + "/index") << "{\"offers\":[{}]}";
    const auto found = box_->entries();
    ASSERT_FALSE(found.has_value());
    EXPECT_NE(found.error().message.find("index is damaged"), std::string::npos);
    EXPECT_FALSE(box_->take(offer(2), NOW).has_value());
    EXPECT_EQ(read_file(folder_ + "/index").value(), "{\"offers\":[{}]}");
    EXPECT_TRUE(hasText(1));
}

TEST_F(OfferBoxTest, ReportsAnUnknownStateAndAFileWithoutAName) {
    ASSERT_TRUE(box_->take(offer(1), NOW).has_value());
    const std::string index = read_file(folder_ + "/index").value();
    for (const auto &[from, to, why] :
         {std::array<std::string, 3>{"\"state\": \"received\"", "\"state\": \"lost\"",
                                     "the state lost is unknown"},
          {"\"a.ngc\"", "7", "a file has no name"}}) {
        const std::size_t at = index.find(from);
        ASSERT_NE(at, std::string::npos) << index;
        std::string changed = index;
        std::ofstream(folder_ + "/index") << changed.replace(at, from.size(), to);
        const auto found = box_->entries();
        ASSERT_FALSE(found.has_value());
        EXPECT_NE(found.error().message.find(why), std::string::npos) << found.error().message;
    }
}

TEST_F(OfferBoxTest, RejectsAChangedText) {
    ASSERT_TRUE(box_->take(offer(1), NOW).has_value());
    ASSERT_TRUE(write_file_atomically(folder_ + '/' + id_of(1) + ".json", encode(offer(2))).has_value());
    int written = 0;
    EXPECT_FALSE(box_->accept(id_of(1), "Jo", NOW,
                              [&](const Offer &) -> Result<> {
                                  ++written;
                                  return {};
                              })
                     .has_value());
    EXPECT_EQ(written, 0);
    EXPECT_EQ(state(1), State::RECEIVED);
}

/// Publisher and screen as two processes: each offer is either accepted or withdrawn, never both, and none is
/// lost.
TEST_F(OfferBoxTest, IsSharedByTwoProcesses) {
    constexpr int COUNT = 40;
    for (int i = 0; i < COUNT; ++i) {
        ASSERT_TRUE(box_->take(offer(i), NOW).has_value());
    }
    std::atomic<int> written{0}, accepted{0};
    std::thread screen([&] {
        OfferBox own = OfferBox::open(folder_).value();
        for (int i = 0; i < COUNT; ++i) {
            accepted += own.accept(id_of(i), "Jo", NOW,
                                   [&](const Offer &) -> Result<> {
                                       ++written;
                                       return {};
                                   })
                                .has_value()
                            ? 1
                            : 0;
        }
    });
    for (int i = COUNT - 1; i >= 0; --i) {
        ASSERT_TRUE(box_->withdraw({id_of(i)}, NOW).has_value());
    }
    screen.join();
    const auto entries = box_->entries().value();
    const auto count = [&entries](State state) {
        return std::ranges::count_if(entries,
                                     [state](const Entry &one) { return one.standing.state == state; });
    };
    EXPECT_EQ(written, accepted);
    EXPECT_EQ(count(State::ACCEPTED), accepted);
    EXPECT_EQ(count(State::ACCEPTED) + count(State::WITHDRAWN), COUNT);
}

TEST_F(OfferBoxTest, IsOnlyForThisUser) {
    struct stat facts{};
    ASSERT_EQ(::stat(folder_.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777U, 0700U);
}

}  // namespace
}  // namespace mw::offers
