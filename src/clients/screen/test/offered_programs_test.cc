// SPDX-License-Identifier: GPL-2.0-or-later
// Tests that an accepted offer becomes a program, that nothing is replaced without a question, and that
// nothing else of the machine changes.
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/screen/files/offered_programs.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string ID = "0d9b0f6e-6f3f-4c39-9b53-2f6c5d2f3a10";
const Requester JO{"10.0.0.7", Role::OPERATE};

class OfferedProgramsTest : public testing::Test {
  protected:
    OfferedProgramsTest() {
        std::string name = (fs::temp_directory_path() / "mw-offered-XXXXXX").string();
        EXPECT_NE(::mkdtemp(name.data()), nullptr);
        base_ = name;
        programs_ = base_ / "programs";
        fs::create_directory(programs_);
        files_.emplace(programs_.string(), std::vector<std::string>{".ngc"});
        offered_.emplace((base_ / "offers").string(), *files_);
        offers::Offer offer{.id = ID,
                            .from = "Eva",
                            .note = "soft jaws",
                            .parts = 20,
                            .sha256 = {},
                            .files = {{"part.ngc", "new\n"}, {"hole.ngc", "sub\n"}}};
        offer.sha256 = offers::sha256_of(offer.files);
        EXPECT_TRUE(offers::OfferBox::open((base_ / "offers").string()).value().take(offer, 1).has_value());
    }
    ~OfferedProgramsTest() override { fs::remove_all(base_); }

    Response decide(const json &decision, const ProgramUse &use = {}) {
        return offered_->decide(ID, decision.dump(), JO, use);
    }
    Response accept(bool isReplacing = false, const ProgramUse &use = {}) {
        return decide({{"decision", "accept"}, {"replace", isReplacing}, {"by", "Jo"}}, use);
    }
    std::string text(const std::string &name) const {
        return read_file((programs_ / name).string()).value_or("none");
    }
    std::size_t count_files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(programs_), fs::directory_iterator()));
    }
    json first() const { return json::parse(offered_->list().body)["offers"][0]; }

    fs::path base_, programs_;
    std::optional<ProgramFiles> files_;
    std::optional<OfferedPrograms> offered_;
};

TEST_F(OfferedProgramsTest, AreListedAndReadBeforeTheDecision) {
    EXPECT_EQ(first()["name"], "part.ngc");
    EXPECT_EQ(first()["from"], "Eva");
    EXPECT_EQ(first()["parts"], 20);
    EXPECT_EQ(first()["state"], "received");
    EXPECT_EQ(first()["files"], (json{"part.ngc", "hole.ngc"}));
    EXPECT_EQ(json::parse(offered_->read(ID).body)["files"][0]["text"], "new\n");
    EXPECT_EQ(count_files(), 0) << "an offer is no program";
}

TEST_F(OfferedProgramsTest, BecomeProgramsAndAJob) {
    EXPECT_EQ(accept().status, 200);
    EXPECT_EQ(text("part.ngc"), "new\n");
    EXPECT_EQ(text("hole.ngc"), "sub\n");
    EXPECT_EQ(count_files(), 2);
    EXPECT_EQ(first()["state"], "accepted");
    EXPECT_EQ(first()["by"], "Jo (10.0.0.7)");
    EXPECT_TRUE(first()["job"]);
    EXPECT_EQ(decide({{"decision", "finish"}}).status, 200);
    EXPECT_FALSE(first()["job"]);
}

TEST_F(OfferedProgramsTest, ReplaceNothingWithoutAQuestion) {
    std::ofstream(programs_ / "hole.ngc") << "old\n";
    const Response asked = accept();
    EXPECT_EQ(asked.status, 409);
    EXPECT_EQ(json::parse(asked.body)["replaces"], json{"hole.ngc"});
    EXPECT_EQ(text("hole.ngc"), "old\n");
    EXPECT_EQ(text("part.ngc"), "none") << "all files or none";
    EXPECT_EQ(first()["state"], "received");
    EXPECT_EQ(accept(true).status, 200);
    EXPECT_EQ(text("hole.ngc"), "sub\n");
    EXPECT_EQ(text("hole.ngc~"), "old\n") << "the former version is kept";
}

TEST_F(OfferedProgramsTest, AskNothingAboutAnEqualFile) {
    std::ofstream(programs_ / "hole.ngc") << "sub\n";
    EXPECT_EQ(accept().status, 200);
    EXPECT_EQ(count_files(), 2);
}

TEST_F(OfferedProgramsTest, ReplaceALinkAndNotItsTarget) {
    std::ofstream(base_ / "outside") << "secret\n";
    fs::create_symlink(base_ / "outside", programs_ / "part.ngc");
    fs::create_symlink(base_ / "nowhere", programs_ / "hole.ngc");
    EXPECT_EQ(json::parse(accept().body)["replaces"].size(), 2);
    EXPECT_EQ(accept(true).status, 200);
    EXPECT_EQ(read_file((base_ / "outside").string()).value(), "secret\n");
    EXPECT_FALSE(fs::exists(base_ / "nowhere"));
    EXPECT_FALSE(fs::is_symlink(programs_ / "part.ngc"));
}

TEST_F(OfferedProgramsTest, AreNotAcceptedInPlaceOfAFolder) {
    fs::create_directory(programs_ / "part.ngc");
    EXPECT_EQ(accept(true).status, 409);
    EXPECT_EQ(first()["state"], "received");
}

TEST_F(OfferedProgramsTest, DoNotChangeTheMachineWhileAProgramRuns) {
    const Response found = accept(true, {.isRunning = true, .open = {}});
    EXPECT_EQ(found.status, 409);
    EXPECT_FALSE(json::parse(found.body).contains("replaces"));
    EXPECT_EQ(count_files(), 0);
}

TEST_F(OfferedProgramsTest, DoNotReplaceTheOpenProgram) {
    std::ofstream(programs_ / "part.ngc") << "old\n";
    EXPECT_EQ(accept(true, {.isRunning = false, .open = (programs_ / "part.ngc").string()}).status, 409);
    EXPECT_EQ(text("part.ngc"), "old\n");
    EXPECT_EQ(accept(true, {.isRunning = false, .open = (programs_ / "other.ngc").string()}).status, 200);
}

TEST_F(OfferedProgramsTest, AreDeclinedWithAReason) {
    EXPECT_EQ(decide({{"decision", "decline"}, {"reason", "no stock"}}).status, 200);
    EXPECT_EQ(first()["state"], "declined");
    EXPECT_EQ(first()["reason"], "no stock");
    EXPECT_EQ(first()["by"], "10.0.0.7");
    EXPECT_EQ(accept(true).status, 409);
    EXPECT_EQ(count_files(), 0);
}

TEST_F(OfferedProgramsTest, NeedAClearDecision) {
    for (const char *body : {"", "[]", "\xff", R"({"decision":"run"})",
                             R"({"decision":"accept","by":"a\nb"})", R"({"decision":1})"}) {
        EXPECT_EQ(offered_->decide(ID, body, JO, {}).status, 400) << body;
    }
    for (const char *id : {"../../etc/passwd", "", "00000000-0000-4000-8000-000000000000"}) {
        EXPECT_EQ(offered_->decide(id, R"({"decision":"accept"})", JO, {}).status, 409) << id;
        EXPECT_EQ(offered_->read(id).status, 404);
    }
    EXPECT_EQ(first()["state"], "received");
}

TEST_F(OfferedProgramsTest, AreOffWithoutAFolder) {
    OfferedPrograms off("", *files_);
    EXPECT_EQ(json::parse(off.list().body), (json{{"enabled", false}, {"offers", json::array()}}));
    EXPECT_EQ(off.decide(ID, R"({"decision":"accept"})", JO, {}).status, 404);
    EXPECT_EQ(off.read(ID).status, 404);
}

}  // namespace
}  // namespace mw::screen
