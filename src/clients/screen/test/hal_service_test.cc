// SPDX-License-Identifier: GPL-2.0-or-later
// Tests HAL for screens with a machine under the virtual clock (B7, J3).
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "clients/screen/hal/hal_service.hh"
#include "components/test/bench.hh"

namespace mw::screen {
namespace {

using Json = nlohmann::json;

constexpr const char *SIGGEN = "loadrt siggen\naddf siggen.0.update t\nsetp siggen.0.frequency 10\n"
                               "net wave siggen.0.sine\nnewsig free float\n";

class HalDeskTest : public testing::Test {
  protected:
    HalDeskTest() : desk([this] { return connect(); }) {}
    /// The bench keeps its host; the service gets a second handle for it.
    Result<std::unique_ptr<hal::Host>> connect() {
        if (!up) {
            return fail("no machine is running");
        }
        return std::make_unique<Borrowed>(*bench.host);
    }
    class Borrowed final : public hal::Host {
      public:
        explicit Borrowed(hal::Host &host) : host_(host) {}
        hal::Instance &hal() noexcept override { return host_.hal(); }
        Result<> load_realtime(const std::string &name, const std::vector<std::string> &args) override {
            return host_.load_realtime(name, args);
        }
        Result<> unload_realtime(const std::string &name) override { return host_.unload_realtime(name); }
        Result<bool> isModuleLoaded(const std::string &name) override { return host_.isModuleLoaded(name); }
        Result<std::vector<std::string>> modules() override { return host_.modules(); }
        Result<> set_log_level(runtime::LogLevel level) override { return host_.set_log_level(level); }

      private:
        hal::Host &host_;
    };
    static Json body(const Response &response) { return Json::parse(response.body); }
    std::string state() { return body(desk.scope("GET", ""))["state"]; }

    components::test::Bench bench{SIGGEN};
    bool up = true;
    HalService desk;
};

TEST_F(HalDeskTest, ListsWhatThereIs) {
    const Json all = body(desk.list("siggen.0.*"));
    EXPECT_TRUE(all["signals"].empty());
    bool has_frequency = false;
    for (const Json &pin : all["pins"]) {
        has_frequency =
            has_frequency || (pin["name"] == "siggen.0.frequency" && pin["value"] == 10.0 &&
                              pin["type"] == "float" && pin["dir"] == "IN" && pin["signal"] == "");
    }
    EXPECT_TRUE(has_frequency) << all["pins"].dump();
    const Json wave = body(desk.list("wave"))["signals"][0];
    EXPECT_EQ(wave["writers"], 1);
    EXPECT_EQ(wave["pins"][0]["name"], "siggen.0.sine");
    up = false;
    HalService other([this] { return connect(); });
    EXPECT_EQ(other.list("*").status, 503);
}

TEST_F(HalDeskTest, TellsWhichInputsOfMotionHaveASource) {
    hal::Instance &hal = bench.hal();
    const auto motion = hal.components().create("motion");
    ASSERT_TRUE(motion.has_value());
    const auto add = [&](const char *name, hal::Type type) {
        ASSERT_TRUE(hal.pins().create(name, type, hal::Dir::IN, *motion).has_value()) << name;
    };
    add("motion.probe-input", hal::Type::BIT);
    for (const char *spindle : {"0", "1"}) {
        add(fmt::format("spindle.{}.speed-in", spindle).c_str(), hal::Type::FLOAT);
        add(fmt::format("spindle.{}.at-speed", spindle).c_str(), hal::Type::BIT);
    }
    bench.run("net no-writer motion.probe-input\nnet wave spindle.1.speed-in\n");
    EXPECT_EQ(body(desk.inputs()), Json::parse(R"({"probe": false, "spindles": [
        {"speed_in": false, "at_speed": false}, {"speed_in": true, "at_speed": false}]})"));
    bench.run("net no-writer siggen.0.clock\nnet no-writer spindle.0.at-speed\n");
    const Json now = body(desk.inputs());
    EXPECT_EQ(now["probe"], true);
    EXPECT_EQ(now["spindles"][0]["at_speed"], true);
    up = false;
    HalService other([this] { return connect(); });
    EXPECT_EQ(other.inputs().status, 503);
}

TEST_F(HalDeskTest, SetsWhatHalcmdSetsAndRefusesWhatItRefuses) {
    EXPECT_EQ(desk.set("siggen.0.frequency", R"({"value":"2.5"})").status, 200);
    EXPECT_EQ(bench.get("siggen.0.frequency"), 2.5);
    EXPECT_EQ(desk.set("free", R"({"value":"7"})").status, 200);
    EXPECT_EQ(desk.look({"free"}).values["free"], "7.0");
    for (const char *name : {"siggen.0.sine", "wave", "nothing"}) {
        const Response refused = desk.set(name, R"({"value":"1"})");
        EXPECT_EQ(refused.status, 400) << name;
        EXPECT_NE(body(refused)["error"], "");
    }
    for (const char *text : {"", "1", "{}", R"({"value":1})", R"({"value":""})"}) {
        EXPECT_EQ(desk.set("siggen.0.frequency", text).status, 400) << text;
    }
    EXPECT_EQ(bench.get("siggen.0.frequency"), 2.5);
}

TEST_F(HalDeskTest, APulseEndsByItself) {
    EXPECT_EQ(desk.set("free", R"({"value":"3"})").status, 200);
    EXPECT_EQ(desk.set("free", R"({"value":"7","pulse_ms":1})").status, 200);
    EXPECT_EQ(desk.look({"free"}).values["free"], "3.0");
    EXPECT_EQ(desk.set("free", R"({"value":"7","pulse_ms":501})").status, 400);
    EXPECT_EQ(desk.set("free", R"({"value":"x","pulse_ms":1})").status, 400);
    EXPECT_EQ(desk.look({"free"}).values["free"], "3.0");
}

TEST_F(HalDeskTest, ReadsValuesAndSaysWhichAreNot) {
    const auto values = desk.look({"siggen.0.frequency", "siggen.0.clock", "gone"}).values;
    EXPECT_EQ(values.at("siggen.0.frequency"), "10.0");
    EXPECT_TRUE(values.at("siggen.0.clock") == "true" || values.at("siggen.0.clock") == "false");
    EXPECT_EQ(values.at("gone"), "null");
}

TEST_F(HalDeskTest, PutsQuestionsOfPinsToScreens) {
    HalService other([this] { return connect(); },
                     {{"door", 0, {.isOk = true}, "Door", "Close it", "", "WARNING"}});
    EXPECT_EQ(other.look({}).questions, "[]");
    bench.set("screen.door", 1);
    const Json asked = Json::parse(other.look({}).questions);
    ASSERT_EQ(asked.size(), 1U);
    EXPECT_EQ(asked[0]["kind"], "ok");
    EXPECT_EQ(asked[0]["text"], "Close it");
    for (const char *text : {"", "{}", R"({"id":"door"})", R"({"id":1,"yes":true})"}) {
        EXPECT_EQ(other.answer(text).status, 400) << text;
    }
    EXPECT_EQ(other.answer(R"({"id":"door","number":0,"yes":true})").status, 200);
    EXPECT_EQ(other.answer(R"({"id":"door","number":0,"yes":true})").status, 409);
    EXPECT_EQ(other.look({}).questions, "[]");
}

TEST_F(HalDeskTest, RecordsAroundATrigger) {
    EXPECT_EQ(state(), "CLOSED");
    const Response begun =
        desk.scope("POST", R"({"names":["wave","siggen.0.clock"],"samples":40,"trigger":"RISING",
        "trigger_name":"wave","level":0.5,"pretrigger":0.25})");
    ASSERT_EQ(begun.status, 200) << begun.body;
    EXPECT_EQ(desk.record().status, 409);
    bench.pass(300);
    ASSERT_EQ(state(), "DONE");
    const Json record = body(desk.record());
    EXPECT_EQ(record["names"], (Json{"wave", "siggen.0.clock"}));
    EXPECT_EQ(record["types"], (Json{"float", "bit"}));
    ASSERT_EQ(record["columns"][0].size(), 40U);
    EXPECT_LE(record["columns"][0][9].get<double>(), 0.5);
    EXPECT_GT(record["columns"][0][10].get<double>(), 0.5);
    EXPECT_EQ(record["times_s"][10], 0.0);
    EXPECT_EQ(desk.scope("DELETE", "").status, 200);
    EXPECT_EQ(state(), "CLOSED");
    EXPECT_EQ(bench.hal().threads().list()[0].functions.size(), 1U);  // only siggen
}

TEST_F(HalDeskTest, ARecordThatWaitsIsTriggeredByHandOrReplaced) {
    const std::string never =
        R"({"names":["wave"],"samples":10,"trigger":"ABOVE","trigger_name":"wave","level":99})";
    ASSERT_EQ(desk.scope("POST", never).status, 200);
    bench.pass(50);
    EXPECT_EQ(state(), "WAITING");
    EXPECT_EQ(desk.force().status, 200);
    bench.pass(50);
    EXPECT_EQ(state(), "DONE");
    ASSERT_EQ(desk.scope("POST", never).status, 200);
    bench.pass(50);
    ASSERT_EQ(desk.scope("POST", R"({"names":["siggen.0.cosine"],"samples":5})").status, 200);
    bench.pass(50);
    ASSERT_EQ(state(), "DONE");
    EXPECT_EQ(body(desk.record())["names"], (Json{"siggen.0.cosine"}));
}

TEST_F(HalDeskTest, SettingsThatMakeNoSenseAreRefused) {
    for (const char *text :
         {"", "[]", "{}", R"({"names":[]})", R"({"names":["gone"]})", R"({"names":"wave"})",
          R"({"names":["wave"],"samples":0})", R"({"names":["wave"],"samples":200000})",
          R"({"names":["wave"],"samples":-1})", R"({"names":["wave"],"trigger":"SOME"})",
          R"({"names":["wave"],"pretrigger":1})", R"({"names":["wave"],"level":"x"})",
          R"({"names":["wave"],"trigger":"RISING"})"}) {
        EXPECT_EQ(desk.scope("POST", text).status, 400) << text;
    }
    EXPECT_EQ(desk.scope("POST", R"({"names":["wave"],"thread":"other"})").status, 409);
    EXPECT_EQ(desk.force().status, 409);
}

}  // namespace
}  // namespace mw::screen
