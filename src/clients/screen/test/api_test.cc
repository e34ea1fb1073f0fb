// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the routes of docs/reference/api.md (J3).
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "clients/screen/access/access.hh"
#include "clients/screen/routes/api.hh"
#include "clients/screen/test/fakes.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/declarations/json.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;
using test::FakeSockets;
using test::FakeTask;
using test::Here;
using test::Json;

class ApiTest : public testing::Test {
  protected:
    ApiTest() {
        const auto *info = testing::UnitTest::GetInstance()->current_test_info();
        folder =
            fs::temp_directory_path() / (std::string("mw_api_") + info->name() + std::to_string(::getpid()));
        fs::create_directories(folder / "web");
        std::ofstream(folder / "web/index.html") << "page";
        ApiSetup setup;
        setup.facts.name = "Mill";
        setup.facts.axes = "XYZ";
        setup.facts.program_prefix = folder.string();
        setup.facts.program_extensions = {".ngc", ".png"};
        setup.facts.increments = {{"0.1 in", 2.54, false}};
        setup.facts.tabs = {{"Door", "", Tab::Kind::PANEL,
                             R"({"parts": [{"kind": "switch", "label": "Door", "name": "door"}]})"}};
        setup.screen_folder = (folder / "web").string();
        setup.offers_folder = (folder / "offers").string();
        setup.screens.connect = [this] { return client::Client::join(task.memory.segment()); };
        setup.read_times = [this](const std::string &, const TimeOverrides &at,
                                  const Requester &) -> Result<std::shared_ptr<PieceQueue>> {
            overrides = at;
            return std::make_shared<PieceQueue>();
        };
        setup.facts.filters = {{".png", ".py"}, "/made"};
        setup.run_filter = [this](const std::string &path, const std::string &made,
                                  const Requester &) -> Result<std::shared_ptr<PieceQueue>> {
            filtered = {path, made};
            return std::make_shared<PieceQueue>();
        };
        setup.read_path = [this](const std::string &path,
                                 const Requester &) -> Result<std::shared_ptr<PieceQueue>> {
            read.push_back(path);
            return read.size() < 2 ? Result<std::shared_ptr<PieceQueue>>(std::make_shared<PieceQueue>())
                                   : fail("too many");
        };
        setup.connect_hal = []() -> Result<std::unique_ptr<hal::Host>> {
            return fail("no machine is running");
        };
        api.emplace(sockets, Threads{here, here}, std::move(setup), [this] { return now_ns += 1000000; });
    }
    ~ApiTest() override {
        api.reset();
        fs::remove_all(folder);
    }
    Response ask(const std::string &method, const std::string &target, const std::string &body = "") {
        Request request = *parse_target(target);
        request.method = method;
        request.body = body;
        request.role = role;
        Response answer;
        int answers = 0;
        api->answer(request, [&](Response one) {
            answer = std::move(one);
            ++answers;
        });
        EXPECT_EQ(answers, 1) << target;
        return answer;
    }

    fs::path folder;
    Role role = Role::CONFIGURE;
    FakeTask task;
    FakeSockets sockets;
    Here here;
    TimeOverrides overrides;
    std::vector<std::string> read, filtered;
    std::int64_t now_ns = 1;
    std::optional<Api> api;
};

TEST_F(ApiTest, TheToolTableIsTold) {
    EXPECT_EQ(ask("GET", "/api/tools").status, 503) << "no machine is running";
    messages::ToolTable table;
    table.version = 7;
    table.tools.resize(2);
    table.tools[1].toolno = 12;
    table.tools[1].comment = "end mill";
    ASSERT_TRUE(task.desk.publish_tools(table));
    task.cycle();
    api->tick();
    for (int i = 0; i < 2; ++i) {  // unchanged when requested again
        const Json told = Json::parse(ask("GET", "/api/tools").body);
        EXPECT_EQ(told["version"], 7);
        EXPECT_EQ(told["tools"][1]["toolno"], 12);
        EXPECT_EQ(told["tools"][1]["comment"], "end mill");
    }
    table.version = 8;
    table.tools[1].toolno = 13;
    ASSERT_TRUE(task.desk.publish_tools(table));
    EXPECT_EQ(Json::parse(ask("GET", "/api/tools").body)["tools"][1]["toolno"], 13);
}

TEST_F(ApiTest, TheSchemaHasEveryCommandAndStatusOfTheVocabulary) {
    const Json schema = Json::parse(ask("GET", "/api/schema").body);
    EXPECT_EQ(schema["commands"].size(), messages::command_declarations().size());
    EXPECT_EQ(schema["status"].size(), messages::status_declarations().size());
    for (const Json &command : schema["commands"]) {
        if (command["name"] == "JogStop") {
            EXPECT_EQ(command["fields"][0]["name"], "is_joint");
            EXPECT_EQ(command["fields"][0]["type"], "bool");
            EXPECT_EQ(command["fields"][1]["max"], 15);
        }
        if (command["name"] == "SetState") {
            EXPECT_EQ(command["fields"][0]["names"], Json::parse(R"(["ESTOP","ESTOP_RESET","OFF","ON"])"));
        }
    }
}

TEST_F(ApiTest, TheMachineIsWhatTheIniSays) {
    const Json machine = Json::parse(ask("GET", "/api/machine").body);
    EXPECT_EQ(machine["name"], "Mill");
    EXPECT_EQ(machine["axes"], "XYZ");
    EXPECT_EQ(machine["increments"], Json::parse(R"([{"text":"0.1 in","value":2.54,"angular":false}])"));
    EXPECT_EQ(machine["program_extensions"], Json::parse(R"([".ngc",".png"])"));
    EXPECT_EQ(machine["filter_extensions"], Json::parse(R"([".png", ".py"])"));
}

TEST_F(ApiTest, ProgramsComeInPiecesAndGo) {
    EXPECT_EQ(ask("PUT", "/api/files/a%20b.ngc?offset=0&size=6", "G0X1").status, 200);
    EXPECT_EQ(ask("PUT", "/api/files/a%20b.ngc?offset=5&size=6", "\n").status, 409);
    EXPECT_EQ(ask("PUT", "/api/files/a%20b.ngc?offset=4&size=6", "\nM").status, 200);
    EXPECT_EQ(ask("GET", "/api/files/a%20b.ngc").body, "G0X1\nM");
    EXPECT_EQ(Json::parse(ask("GET", "/api/files").body)["files"][0]["name"], "a b.ngc");
    EXPECT_EQ(ask("PUT", "/api/files/whole.ngc", "M2").status, 200);
    EXPECT_EQ(ask("PUT", "/api/files/x.ngc?offset=0", "M2").status, 400);
    EXPECT_EQ(ask("PUT", "/api/files/x.ngc?offset=-1&size=2", "M2").status, 400);
    EXPECT_EQ(ask("DELETE", "/api/files/a%20b.ngc").status, 200);
    EXPECT_EQ(ask("GET", "/api/files/a%20b.ngc").status, 404);
    EXPECT_EQ(ask("GET", "/api/files/..%2fx.ngc").status, 400);
    EXPECT_EQ(ask("POST", "/api/files/whole.ngc").status, 400);
    EXPECT_EQ(ask("DELETE", "/api/files").status, 400);
}

TEST_F(ApiTest, OnlyConfigureAddsFilesThatAFilterRuns) {
    role = Role::OPERATE;
    EXPECT_EQ(ask("PUT", "/api/files/evil.py", "import os").status, 403);
    EXPECT_EQ(ask("PUT", "/api/files/evil.PY?offset=0&size=9", "import os").status, 403);
    EXPECT_FALSE(fs::exists(folder / "evil.py"));
    EXPECT_NE(ask("PUT", "/api/files/part.ngc", "M2").status, 403);
    EXPECT_NE(ask("PUT", "/api/files/photo.png", "x").status, 403);
    role = Role::CONFIGURE;
    EXPECT_NE(ask("PUT", "/api/files/good.py", "print('M2')").status, 403);
}

TEST_F(ApiTest, AFilterRunsForItsExtensionAndItsProgramIsRead) {
    EXPECT_EQ(ask("POST", "/api/filter?file=a.ngc").status, 400) << "no filter for it";
    EXPECT_EQ(ask("POST", "/api/filter?file=../a.png").status, 400);
    EXPECT_EQ(ask("GET", "/api/filter?file=a.png").status, 404);
    EXPECT_NE(ask("POST", "/api/filter?file=a.PNG").pieces, nullptr);
    EXPECT_EQ(filtered, (std::vector<std::string>{folder.string() + "/a.PNG", "/made/a.PNG.ngc"}));
    role = Role::VIEW;
    EXPECT_EQ(ask("POST", "/api/filter?file=a.png").status, 403);
    EXPECT_NE(ask("GET", "/api/path?file=a.png").pieces, nullptr);
    EXPECT_EQ(read, std::vector<std::string>{"/made/a.png.ngc"});
    EXPECT_EQ(ask("GET", "/api/files/a.png?made").status, 404) << "nothing is made yet";
}

TEST_F(ApiTest, TimesAreAskedForAtOverrides) {
    for (const char *wrong : {"", "?file=a.ngc&feed=0", "?file=a.ngc&feed=x", "?file=a.ngc&rapid=-1",
                              "?file=a.ngc&max_velocity=inf", "?file=../a.ngc"}) {
        EXPECT_EQ(ask("GET", std::string("/api/times") + wrong).status, 400) << wrong;
    }
    EXPECT_NE(ask("GET", "/api/times?file=a.ngc&feed=0.5&rapid=0.25&max_velocity=12").pieces, nullptr);
    EXPECT_EQ(overrides.feed, 0.5);
    EXPECT_EQ(overrides.rapid, 0.25);
    EXPECT_EQ(overrides.max_velocity, 12);
}

TEST_F(ApiTest, ThePathOfAProgramIsReadWhileItIsSent) {
    EXPECT_EQ(ask("GET", "/api/path").status, 400);
    EXPECT_EQ(ask("GET", "/api/path?file=../a.ngc").status, 400);
    EXPECT_TRUE(read.empty());
    EXPECT_NE(ask("GET", "/api/path?file=a.ngc").pieces, nullptr);
    EXPECT_EQ(read, std::vector<std::string>{folder.string() + "/a.ngc"});
    EXPECT_EQ(ask("GET", "/api/path?file=a.ngc").status, 429);
}

TEST_F(ApiTest, PagesFiguresAndWhatThereIsNot) {
    EXPECT_EQ(ask("GET", "/").body, "page");
    EXPECT_EQ(ask("GET", "/assets/none.js").status, 404);
    EXPECT_EQ(ask("GET", "/api/none").status, 404);
    EXPECT_EQ(ask("PUT", "/", "x").status, 400);
    EXPECT_FALSE(Json::parse(ask("GET", "/api/none").body)["error"].get<std::string>().empty());
    EXPECT_NE(ask("GET", "/metrics").body.find("\nmillwright_machine_up 0\n"), std::string::npos);
    task.cycle();
    api->tick();
    EXPECT_NE(ask("GET", "/metrics").body.find("\nmillwright_machine_up 1\n"), std::string::npos);
}

/// A decision about an offer sends no command to the machine, and needs a machine that runs no program.
TEST_F(ApiTest, AnOfferIsAcceptedWithoutACommand) {
    offers::Offer offer{.id = "0d9b0f6e-6f3f-4c39-9b53-2f6c5d2f3a10",
                        .from = "Eva",
                        .note = {},
                        .parts = 1,
                        .sha256 = {},
                        .files = {{"part.ngc", "M2\n"}}};
    offer.sha256 = offers::sha256_of(offer.files);
    ASSERT_TRUE(offers::OfferBox::open((folder / "offers").string()).value().take(offer, 1).has_value());
    const std::string target = "/api/offers/" + offer.id, accept = R"({"decision": "accept"})";
    const auto show = [this](messages::InterpState state) {
        task.status->task.interp_state = state;
        task.cycle();
        for (int i = 0; i < 1000; ++i) {  // each advances the clock
            api->tick();
        }
    };
    show(messages::InterpState::PAUSED);
    EXPECT_EQ(ask("POST", target, accept).status, 409);
    show(messages::InterpState::IDLE);
    EXPECT_EQ(ask("POST", target, accept).status, 200);
    EXPECT_TRUE(fs::exists(folder / "part.ngc"));
    EXPECT_TRUE(task.cycle().empty()) << "no command";
    EXPECT_EQ(Json::parse(ask("GET", "/api/offers").body)["offers"][0]["state"], "accepted");
}

/// The table of docs/reference/api.md, Who may: each row is a request and the minimum role that it needs.
TEST_F(ApiTest, EachRequestNeedsTheRoleOfTheTable) {
    struct Row {
        const char *method, *target, *body;
        Role least;
    };
    constexpr Role ALL[] = {Role::STATUS, Role::VIEW, Role::OPERATE, Role::CONFIGURE};
    const Row rows[] = {
        {"GET", "/api/machine", "", Role::STATUS},
        {"GET", "/api/schema", "", Role::STATUS},
        {"GET", "/api/tools", "", Role::STATUS},
        {"GET", "/api/files", "", Role::VIEW},
        {"GET", "/api/files/a.ngc", "", Role::VIEW},
        {"GET", "/api/offers", "", Role::VIEW},
        {"GET", "/api/offers/00000000-0000-4000-8000-000000000000", "", Role::VIEW},
        {"POST", "/api/offers/00000000-0000-4000-8000-000000000000", R"({"decision": "accept"})",
         Role::OPERATE},
        {"GET", "/api/path?file=a.ngc", "", Role::VIEW},
        {"GET", "/api/times?file=a.ngc", "", Role::VIEW},
        {"GET", "/api/offsets", "", Role::VIEW},
        {"GET", "/api/certificate", "", Role::VIEW},
        {"GET", "/api/preferences", "", Role::VIEW},
        {"GET", "/api/mdi_history", "", Role::VIEW},
        {"GET", "/api/icon", "", Role::STATUS},
        {"GET", "/api/hal?glob=*", "", Role::VIEW},
        {"GET", "/api/inputs", "", Role::VIEW},
        {"GET", "/api/scope", "", Role::VIEW},
        {"GET", "/api/scope/record", "", Role::VIEW},
        {"GET", "/metrics", "", Role::STATUS},
        {"PUT", "/api/files/a.ngc", "G0 X1", Role::OPERATE},
        {"DELETE", "/api/files/a.ngc", "", Role::OPERATE},
        {"PUT", "/api/preferences", "{}", Role::OPERATE},
        {"PUT", "/api/mdi_history", R"({"lines": []})", Role::OPERATE},
        {"POST", "/api/questions", R"({"id": "door", "number": 0, "yes": true})", Role::OPERATE},
        {"PUT", "/api/hal/door", R"({"value": "1"})", Role::OPERATE},
        {"PUT", "/api/hal/joint.0.amp-enable-out", R"({"value": "1"})", Role::CONFIGURE},
        {"POST", "/api/scope", "{}", Role::CONFIGURE},
        {"POST", "/api/scope/force", "", Role::CONFIGURE},
        {"DELETE", "/api/scope", "", Role::CONFIGURE},
    };
    for (const Row &row : rows) {
        for (const Role asking : ALL) {
            role = asking;
            const Response answer = ask(row.method, row.target, row.body);
            const bool refused =
                answer.status == 403 && answer.body.find("needs a token of the role") != std::string::npos;
            EXPECT_EQ(refused, asking < row.least)
                << row.method << ' ' << row.target << " as " << role_name(asking) << ": " << answer.status
                << ' ' << answer.body;
        }
    }
}

TEST_F(ApiTest, EachCommandIsAStopOrNeedsAnOperator) {
    const std::set<std::string> stops{"AbortAll", "JogStop", "PauseProgram"};
    constexpr Role ALL[] = {Role::STATUS, Role::VIEW, Role::OPERATE, Role::CONFIGURE};
    task.cycle();
    api->tick();
    for (SessionId i = 0; i < std::size(ALL); ++i) {
        api->opened(i, ALL[i], Protection::TLS);
    }
    for (const messages::Declaration *declaration : messages::command_declarations()) {
        const auto command = messages::make_command(declaration->number);
        ASSERT_TRUE(command.has_value()) << declaration->name;
        if (std::holds_alternative<messages::SetState>(*command)) {
            continue;  // below
        }
        for (SessionId session = 0; session < std::size(ALL); ++session) {
            const Role asking = ALL[session];
            sockets.take(session);
            Json text{{"id", 1}, {"command", Json::parse(messages::to_json(messages::object(*command)))}};
            for (Json &value : text["command"]) {
                value =
                    value == "" ? Json("x") : value;  // an empty text is rejected before the role is checked
            }
            api->received(session, text.dump());
            task.cycle();
            api->tick();
            bool of_role = false;
            for (const Json &told : sockets.take(session)) {
                of_role |= told.dump().find("may look, and stop, but not operate") != std::string::npos;
            }
            const bool stop = stops.contains(std::string(declaration->name));
            EXPECT_EQ(of_role, asking <= Role::VIEW && !stop)
                << declaration->name << " as " << role_name(asking);
        }
    }
    // For SetState the role depends on the state.
    for (const auto &[state, stop] :
         {std::pair("ESTOP", true), {"OFF", true}, {"ON", false}, {"ESTOP_RESET", false}}) {
        constexpr SessionId VIEWER = 0;
        sockets.take(VIEWER);
        api->received(VIEWER, std::string(R"({"id": 1, "command": {"message": "SetState", "state": ")") +
                                  state + R"("}})");
        task.cycle();
        api->tick();
        EXPECT_EQ(Json(sockets.take(VIEWER)).dump().find("may look, and stop") == std::string::npos, stop)
            << state;
    }
}

}  // namespace
}  // namespace mw::screen
