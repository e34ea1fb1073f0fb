// SPDX-License-Identifier: GPL-2.0-or-later
// Tests small files that screens keep (J1, J3).
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/screen/files/user_files.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class KeepsakesTest : public testing::Test {
  protected:
    KeepsakesTest() {
        const auto *info = testing::UnitTest::GetInstance()->current_test_info();
        folder =
            fs::temp_directory_path() / (std::string("mw_keep_") + info->name() + std::to_string(::getpid()));
        fs::create_directories(folder);
        facts.files.mdi_history = (folder / "mdi").string();
        facts.files.preferences = (folder / "preferences").string();
        facts.files.parameters = (folder / "machine.var").string();
        facts.files.certificate = (folder / "certificate").string();
    }
    ~KeepsakesTest() override { fs::remove_all(folder); }
    static Request request(const std::string &method, const std::string &body = "") {
        Request one;
        one.method = method;
        one.body = body;
        return one;
    }
    static Json body(const Response &response) { return Json::parse(response.body); }

    fs::path folder;
    MachineFacts facts;
};

TEST_F(KeepsakesTest, TheCertificateIsThatOfTheMachine) {
    const UserFiles keep(facts);
    EXPECT_EQ(keep.certificate().status, 404);
    std::ofstream(facts.files.certificate) << R"({"finished":true})";
    EXPECT_EQ(keep.certificate().status, 200);
    EXPECT_EQ(body(keep.certificate())["finished"], true);
}

TEST_F(KeepsakesTest, LinesOfMdiAreKeptAsTextThatOtherScreensRead) {
    const UserFiles keep(facts);
    EXPECT_EQ(body(keep.mdi_history(request("GET")))["lines"], Json::array());
    EXPECT_EQ(keep.mdi_history(request("PUT", R"({"lines":["G0 X1","M3 S100"]})")).status, 200);
    EXPECT_EQ(*read_file(facts.files.mdi_history), "G0 X1\nM3 S100\n");
    std::ofstream(facts.files.mdi_history, std::ios::app) << "\n  G1 Y2 \n";
    EXPECT_EQ(body(keep.mdi_history(request("GET")))["lines"], (Json{"G0 X1", "M3 S100", "G1 Y2"}));
    for (const char *bad : {"", "[]", R"({"lines":"x"})", R"({"lines":[1]})", R"({"lines":["a\nb"]})"}) {
        EXPECT_EQ(keep.mdi_history(request("PUT", bad)).status, 400) << bad;
    }
    facts.files.mdi_history.clear();
    EXPECT_EQ(UserFiles(facts).mdi_history(request("GET")).status, 404);
}

TEST_F(KeepsakesTest, AnotherScreensPreferencesAreLeftAlone) {
    const UserFiles keep(facts);
    EXPECT_EQ(keep.preferences(request("GET")).body, "{}");
    EXPECT_EQ(keep.preferences(request("PUT", R"({"theme":"dark"})")).status, 200);
    EXPECT_EQ(body(keep.preferences(request("GET")))["theme"], "dark");
    EXPECT_EQ(keep.preferences(request("PUT", "[]")).status, 400);
    EXPECT_EQ(keep.preferences(request("DELETE")).status, 400);
    const std::string other = "[DEFAULT]\nx = 1\n";
    std::ofstream(facts.files.preferences) << other;
    EXPECT_EQ(keep.preferences(request("GET")).status, 409);
    EXPECT_EQ(keep.preferences(request("PUT", "{}")).status, 409);
    EXPECT_EQ(*read_file(facts.files.preferences), other);
}

TEST_F(KeepsakesTest, OffsetsOfAllSystemsAreThoseOfTheParameterFile) {
    std::ofstream(facts.files.parameters)
        << "5211 9\n5221\t1.5\n5230 30\n5241 -2\n5383\t7\n5390 1\n5391 9\nbad line here\n";
    const Json systems = body(UserFiles(facts).offsets())["systems"];
    ASSERT_EQ(systems.size(), 9U);
    EXPECT_EQ(systems[0]["offset"][0], 1.5);
    EXPECT_EQ(systems[0]["rotation_deg"], 30.0);
    EXPECT_EQ(systems[1]["offset"][0], -2.0);
    EXPECT_EQ(systems[8]["offset"][2], 7.0);
    EXPECT_EQ(systems[8]["rotation_deg"], 1.0);
    EXPECT_EQ(systems[2]["offset"][0], 0.0);
}

TEST_F(KeepsakesTest, ThePictureIsAPicture) {
    EXPECT_EQ(UserFiles(facts).icon().status, 404);
    facts.files.icon = (folder / "Logo.PNG").string();
    EXPECT_EQ(UserFiles(facts).icon().status, 404);
    std::ofstream(facts.files.icon) << "picture";
    const Response icon = UserFiles(facts).icon();
    EXPECT_EQ(icon.type, "image/png");
    EXPECT_EQ(icon.body, "picture");
    facts.files.icon = "/etc/passwd";
    EXPECT_EQ(UserFiles(facts).icon().status, 404);
}

}  // namespace
}  // namespace mw::screen
