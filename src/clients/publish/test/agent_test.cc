// SPDX-License-Identifier: GPL-2.0-or-later
// Tests requests of MTConnect and their documents. tests/e2e/publish_mtconnect.py checks the form of all
// documents.
#include <algorithm>
#include <regex>

#include <gtest/gtest.h>

#include "clients/publish/mtconnect/agent.hh"
#include "clients/publish/mtconnect/forms.hh"
#include "clients/publish/mtconnect/service.hh"

namespace mw::publish::mtconnect {
namespace {

constexpr TimeMs NOW = 1'700'000'000'125;

class AgentTest : public ::testing::Test {
  protected:
    AgentTest() {
        status.trajectory.axis_mask = 0b1001;  // X A
        status.trajectory.num_joints = 2;
        status.trajectory.num_spindles = 1;
        status.trajectory.isPositionValid = true;
        status.task.program.assign("/home/op/part & <1>.ngc");
        readings.fit(status);
        agent.born(readings.metrics(), readings.all(status), status.settings.linear_units, NOW);
    }
    void change() { agent.add(readings.changes(status), NOW + 1); }
    Answer get(const std::string &path, const Query &query = {}) {
        return std::get<Answer>(agent.answer(path, query, NOW + 2, 10));
    }
    static std::size_t count(const std::string &text, const std::string &part) {
        std::size_t found = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
            ++found;
        }
        return found;
    }
    /// The value of an element with a data item.
    static std::string value(const std::string &document, const std::string &id) {
        std::smatch found;
        const std::regex pattern("dataItemId=\"" + id + "\"[^>]*>([^<]*)<");
        return std::regex_search(document, found, pattern) ? found[1].str() : "absent";
    }
    static std::uint64_t number(const std::string &document, const std::string &name) {
        std::smatch found;
        const std::regex pattern(name + "=\"([0-9]+)\"");
        return std::regex_search(document, found, pattern) ? std::stoull(found[1].str()) : 0;
    }

    messages::MachineStatus status;
    Readings readings;
    Agent agent{{.device = "Mill", .uuid = "u-1", .sender = "host", .buffer = 100}, NOW};
};

TEST_F(AgentTest, DescribesTheMachine) {
    const std::string probe = get("/probe").body;
    EXPECT_NE(probe.find("<Device id=\"device\" name=\"Mill\" uuid=\"u-1\">"), std::string::npos) << probe;
    EXPECT_NE(probe.find("<Linear id=\"axis_x\" name=\"X\">"), std::string::npos);
    EXPECT_NE(probe.find("<Rotary id=\"axis_a\" name=\"A\">"), std::string::npos);
    EXPECT_NE(probe.find("id=\"axis_a_angle_actual\" type=\"ANGLE\" subType=\"ACTUAL\" units=\"DEGREE\""),
              std::string::npos);
    EXPECT_NE(probe.find("<Rotary id=\"spindle_0\" name=\"S1\">"), std::string::npos);
    EXPECT_EQ(get("/").body, probe);
    EXPECT_EQ(get("/Mill").body, probe);
    EXPECT_EQ(get("/u-1/probe").body, probe);
}

TEST_F(AgentTest, GivesValuesInItsUnitsAndWords) {
    status.trajectory.position_fb[0] = 2;
    status.overrides.feed = 1.5;
    status.spindles[0].speed_in_rps = 10;
    status.task.mode = messages::Mode::MDI;
    status.task.state = messages::State::ON;
    status.settings.linear_units = 1 / 25.4;
    readings.fit(status);
    agent.born(readings.metrics(), readings.all(status), status.settings.linear_units, NOW);
    const std::string current = get("/current").body;
    EXPECT_EQ(value(current, "axis_x_position_actual"), "50.8");
    EXPECT_EQ(value(current, "path_path_feedrate_override_programmed"), "150");
    EXPECT_EQ(value(current, "spindle_0_rotary_velocity_actual"), "600");
    EXPECT_EQ(value(current, "path_controller_mode"), "MANUAL_DATA_INPUT");
    EXPECT_EQ(value(current, "controller_emergency_stop"), "ARMED");
    EXPECT_EQ(value(current, "path_work_offset"), "G54");
    EXPECT_EQ(value(current, "path_program"), "part &amp; &lt;1&gt;.ngc");
    EXPECT_EQ(value(current, "device_availability"), "AVAILABLE");
    EXPECT_NE(current.find("<Normal dataItemId=\"controller_actuator\""), std::string::npos);
}

TEST_F(AgentTest, ReportsFaultsAsConditions) {
    status.joints[1].isFaulted = true;
    change();
    const std::string current = get("/current").body;
    EXPECT_NE(current.find("type=\"ACTUATOR\">Joint 1: amplifier fault.</Fault>"), std::string::npos)
        << current;
    status.joints[1].isFaulted = false;
    change();
    EXPECT_EQ(get("/current").body.find("Fault"), std::string::npos);
}

TEST_F(AgentTest, GivesSamplesBySequence) {
    const std::uint64_t next = number(get("/current").body, "nextSequence");
    for (int line = 1; line <= 5; ++line) {
        status.task.motion_line = line;
        change();
    }
    const std::string from = std::to_string(next);
    const std::string all = get("/sample", {{"from", from}}).body;
    EXPECT_EQ(count(all, "<LineNumber"), 5U) << all;
    EXPECT_EQ(number(all, "nextSequence"), next + 5);
    const std::string two = get("/sample", {{"from", from}, {"count", "2"}}).body;
    EXPECT_EQ(count(two, "<LineNumber"), 2U);
    EXPECT_EQ(number(two, "nextSequence"), next + 2);
    const std::string back = get("/sample", {{"count", "-2"}}).body;
    EXPECT_NE(back.find(">4</LineNumber>"), std::string::npos) << back;
    EXPECT_NE(back.find(">5</LineNumber>"), std::string::npos);
    const std::string none = get("/sample", {{"from", std::to_string(next + 5)}}).body;
    EXPECT_EQ(count(none, "<ComponentStream"), 0U);
    const std::string then = get("/current", {{"at", std::to_string(next + 1)}}).body;
    EXPECT_EQ(value(then, "path_line_number_absolute"), "2");
}

TEST_F(AgentTest, ForgetsTheOldestButKeepsTheState) {
    for (int line = 1; line <= 500; ++line) {
        status.task.motion_line = line;
        change();
    }
    const std::string current = get("/current").body;
    const std::uint64_t first = number(current, "firstSequence"), last = number(current, "lastSequence");
    EXPECT_EQ(last - first + 1, number(current, "bufferSize"));
    EXPECT_EQ(get("/sample", {{"from", "1"}}).status, 404);
    const std::string then = get("/current", {{"at", std::to_string(first)}}).body;
    EXPECT_EQ(value(then, "controller_emergency_stop"), "TRIGGERED") << "of before the first";
}

TEST_F(AgentTest, SelectsByPath) {
    const auto elements = [this](const std::string &path) {
        return count(get("/current", {{"path", path}}).body, "dataItemId=");
    };
    EXPECT_EQ(elements("//DataItem[@type='POSITION' and @category='SAMPLE']"), 2U);
    EXPECT_EQ(elements("//Axes//Linear[@name='X']"), 2U);
    EXPECT_EQ(elements("//Axes//Linear|//Path//DataItem[@category='SAMPLE']"), 4U);
    EXPECT_GT(elements("//Controller"), 10U);
    EXPECT_EQ(elements("/MTConnectDevices/Devices/Device/DataItems"), 3U);
    for (const char *wrong : {"//[", "1+1", "//Nothing", "", "//DataItem[", "count(//DataItem)"}) {
        const Answer answer = get("/current", {{"path", wrong}});
        EXPECT_EQ(answer.status, 400) << wrong;
        EXPECT_NE(answer.body.find("errorCode=\"INVALID_PATH\""), std::string::npos) << answer.body;
    }
    std::string deep;
    for (int i = 0; i < 300; ++i) {
        deep += "//*";
    }
    EXPECT_EQ(get("/current", {{"path", deep}}).status, 400) << "too many steps";
}

TEST_F(AgentTest, RejectsWithAnErrorDocument) {
    const std::vector<std::tuple<std::string, Query, int, std::string>> cases{
        {"/nothing", {}, 404, "NO_DEVICE"},
        {"/Lathe/probe", {}, 404, "NO_DEVICE"},
        {"/Mill/nothing", {}, 404, "INVALID_REQUEST"},
        {"/probe/more", {}, 404, "INVALID_REQUEST"},
        {"/current", {{"device", "Lathe"}}, 404, "NO_DEVICE"},
        {"/current", {{"at", "0"}}, 404, "OUT_OF_RANGE"},
        {"/current", {{"at", "99999"}}, 404, "OUT_OF_RANGE"},
        {"/current", {{"at", "x"}}, 404, "OUT_OF_RANGE"},
        {"/current", {{"at", "5"}, {"interval", "10"}}, 400, "INVALID_REQUEST"},
        {"/sample", {{"from", "-1"}}, 404, "OUT_OF_RANGE"},
        {"/sample", {{"from", "99999999999999999999"}}, 404, "OUT_OF_RANGE"},
        {"/sample", {{"count", "0"}}, 404, "OUT_OF_RANGE"},
        {"/sample", {{"count", "100000"}}, 404, "OUT_OF_RANGE"},
        {"/sample", {{"interval", "-1"}}, 400, "OUT_OF_RANGE"},
        {"/sample", {{"interval", "1"}, {"heartbeat", "0"}}, 400, "OUT_OF_RANGE"},
        {"/sample", {{"interval", "1"}, {"count", "-1"}}, 400, "OUT_OF_RANGE"},
        {"/asset/none", {}, 404, "ASSET_NOT_FOUND"},
        {"/assets", {{"count", "0"}}, 400, "OUT_OF_RANGE"}};
    for (const auto &[path, query, code, name] : cases) {
        const Answer answer = get(path, query);
        EXPECT_EQ(answer.status, code) << path << answer.body;
        EXPECT_NE(answer.body.find("errorCode=\"" + name + "\""), std::string::npos) << path << answer.body;
    }
}

TEST_F(AgentTest, BeginsAgainWithAnotherMachineAndKeepsTheSame) {
    const std::uint64_t instance = number(get("/probe").body, "instanceId");
    agent.gone(NOW);
    const std::string gone = get("/current").body;
    EXPECT_EQ(value(gone, "device_availability"), "UNAVAILABLE");
    EXPECT_EQ(value(gone, "axis_x_position_actual"), "UNAVAILABLE");
    EXPECT_NE(gone.find("<Unavailable dataItemId=\"controller_actuator\""), std::string::npos);
    agent.born(readings.metrics(), readings.all(status), 1, NOW);
    EXPECT_EQ(number(get("/probe").body, "instanceId"), instance);
    status.trajectory.axis_mask = 0b111;
    readings.fit(status);
    agent.born(readings.metrics(), readings.all(status), 1, NOW);
    EXPECT_GT(number(get("/probe").body, "instanceId"), instance);
}

TEST_F(AgentTest, OffersToolsAsAssets) {
    messages::ToolTable table;
    table.tools.resize(4);
    table.tools[0].toolno = table.tools[1].toolno = 3;
    table.tools[1].pocketno = 7;
    table.tools[1].diameter = 6;
    table.tools[1].comment = "6 mm <end> mill";
    table.tools[1].offset[2] = 80.5;
    table.tools[2].toolno = 4;
    agent.set_tools(table, NOW);
    const std::string all = get("/assets").body;
    EXPECT_EQ(count(all, "<CuttingTool assetId="), 2U) << all;
    const std::string one = get("/asset/tool-4").body;
    EXPECT_EQ(count(one, "<CuttingTool assetId="), 1U);
    EXPECT_EQ(count(get("/asset/tool-4;tool-3").body, "<CuttingTool assetId="), 2U);
    table.tools.erase(table.tools.begin() + 2);
    table.tools[1].diameter = 6.5;
    agent.set_tools(table, NOW + 5);
    EXPECT_EQ(count(get("/assets").body, "<CuttingTool assetId="), 1U);
    EXPECT_EQ(count(get("/assets", {{"removed", "true"}}).body, "<CuttingTool assetId="), 2U);
    const std::string current = get("/current").body;
    EXPECT_EQ(value(current, "device_asset_removed"), "tool-4");
    EXPECT_EQ(number(get("/probe").body, "assetCount"), 1U);
}

TEST_F(AgentTest, StreamsNewsAndSignsOfLife) {
    auto stream = std::get<Stream>(
        agent.answer("/sample", {{"interval", "100"}, {"heartbeat", "1000"}, {"path", "//Path"}}, NOW, 0));
    EXPECT_TRUE(agent.next(stream, NOW, 0).has_value()) << "what is there";
    EXPECT_FALSE(agent.next(stream, NOW, 0.5).has_value()) << "no news";
    const auto heartbeat = agent.next(stream, NOW, 1.0);
    ASSERT_TRUE(heartbeat.has_value());
    EXPECT_EQ(count(*heartbeat, "<ComponentStream"), 0U);
    status.task.motion_line = 9;
    status.trajectory.position_fb[0] = 1;
    change();
    EXPECT_FALSE(agent.next(stream, NOW, 1.05).has_value()) << "not before the interval";
    const auto news = agent.next(stream, NOW, 1.1);
    ASSERT_TRUE(news.has_value());
    EXPECT_NE(news->find(">9</LineNumber>"), std::string::npos);
    EXPECT_EQ(news->find("<Position"), std::string::npos);
    status.trajectory.position_fb[0] = 2;
    change();
    EXPECT_FALSE(agent.next(stream, NOW, 1.5).has_value()) << "news of other items are none";
}

TEST_F(AgentTest, EndsAStreamThatIsTooSlow) {
    auto stream = std::get<Stream>(agent.answer("/sample", {{"interval", "0"}}, NOW, 0));
    for (int line = 1; line <= 500; ++line) {
        status.task.motion_line = line;
        change();
    }
    const auto last = agent.next(stream, NOW, 1);
    ASSERT_TRUE(last.has_value());
    EXPECT_NE(last->find("OUT_OF_RANGE"), std::string::npos);
    EXPECT_TRUE(stream.isEnded);
    EXPECT_FALSE(agent.next(stream, NOW, 2).has_value());
}

TEST_F(AgentTest, AnswersGetOnlyAndStreamsInParts) {
    double now_s = 0;
    Service service(agent, {[] { return NOW; }, [&now_s] { return now_s; }});
    screen::Response response;
    const auto take = [&response](screen::Response one) { response = std::move(one); };
    service.answer({.method = "POST", .path = "/probe", .query = {}, .body = ""}, take);
    EXPECT_EQ(response.status, 405);
    service.answer({.method = "GET", .path = "/current", .query = {{"interval", "100"}}, .body = ""}, take);
    ASSERT_NE(response.pieces, nullptr);
    EXPECT_TRUE(service.tick());
    std::string piece;
    ASSERT_EQ(response.pieces->take(piece, [] {}), screen::PieceQueue::State::PIECE);
    EXPECT_TRUE(piece.starts_with("--" + response.type.substr(response.type.find('=') + 1) + "\r\n"))
        << piece;
    // A client that does not read is disconnected, and delays nothing.
    for (int i = 0; i < 5000 && service.tick(); ++i) {
        now_s += 0.1;
    }
    EXPECT_FALSE(service.tick());
}

TEST(MtconnectForms, WriteTimesAndNumbers) {
    EXPECT_EQ(time_text(1'700'000'000'125), "2023-11-14T22:13:20.125Z");
    const DataItem plain;
    EXPECT_EQ(value_text(plain, Value(), 1), "UNAVAILABLE");
    EXPECT_EQ(value_text(plain, std::numeric_limits<double>::quiet_NaN(), 1), "UNAVAILABLE");
    EXPECT_EQ(value_text(plain, -0.0000001, 1), "0");
    EXPECT_EQ(value_text(plain, 10.0, 1), "10");
    EXPECT_EQ(value_text(plain, 100.25, 1), "100.25");
}

}  // namespace
}  // namespace mw::publish::mtconnect
