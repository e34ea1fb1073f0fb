// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the publisher with a machine that starts, works, reports messages and ends.
#include <memory>

#include "clients/publish/assembly/machine_reader.hh"
#include "clients/publish/test/node_world.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::publish {
namespace {

class MachineReaderTest : public ::testing::Test {
  protected:
    MachineReaderTest() { status->trajectory.axis_mask = 1; }
    void publish() {
        desk.take(now_ns += 1'000'000);
        ++status->cycle;
        desk.publish(*status);
    }
    void step() { reader.step(1'700'000'000'000 + static_cast<TimeMs>(now_ns / 1'000'000), now_ns); }
    /// The values of a metric in the newest records.
    std::vector<Value> values(const std::string &name) {
        std::vector<Value> found;
        for (const Record &record : data.read(1, 1000)) {
            const auto payload = decode_payload(record.bytes);
            for (const PayloadMetric &metric : payload->metrics) {
                if (metric.name == name) {
                    found.push_back(metric.value);
                }
            }
        }
        return found;
    }

    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 1'000'000'000;
    bool isThere = true;
    OwnFolder folder;
    LiveData data{DataLog::open(folder.path()).value()};
    mtconnect::Agent agent{{.device = "Mill", .uuid = "u", .sender = "h", .buffer = 1000}, 1'700'000'000'000};
    MachineReader reader{[this]() -> Result<client::Viewer> {
                             return isThere ? Result<client::Viewer>(client::Viewer(memory.segment()))
                                            : fail("no machine");
                         },
                         {},
                         &data,
                         &agent};
};

TEST_F(MachineReaderTest, WaitsForTheMachineAndPassesChanges) {
    isThere = false;
    step();
    EXPECT_FALSE(data.state().isAlive);
    isThere = true;
    publish();
    step();
    EXPECT_FALSE(reader.isAttached()) << "it looks for the machine twice a second";
    now_ns += 600'000'000;
    step();
    EXPECT_TRUE(reader.isAttached());
    EXPECT_TRUE(data.state().isAlive);
    status->task.state = messages::State::ON;
    publish();
    step();
    step();
    EXPECT_EQ(values("State"), (std::vector<Value>{std::string("ESTOP"), std::string("ON")}));
}

TEST_F(MachineReaderTest, PassesEachMessageOnce) {
    publish();
    step();
    desk.post(messages::MessageKind::OPERATOR_ERROR, "Joint 1 following error.");
    publish();
    step();
    step();
    const auto texts = values("Messages/Text");
    ASSERT_EQ(texts.size(), 2U) << "none at the birth, then one";
    EXPECT_EQ(texts[0], Value());
    EXPECT_EQ(texts[1], Value(std::string("Joint 1 following error.")));
    EXPECT_EQ(values("Messages/Type").back(), Value(std::string("ERROR")));
}

TEST_F(MachineReaderTest, PassesNoMessageAgainAfterAStart) {
    desk.post(messages::MessageKind::OPERATOR_TEXT, "first");
    publish();
    MachineReader::Mark kept;
    reader.set_mark({}, [&kept](const MachineReader::Mark &mark) { kept = mark; });
    step();
    ASSERT_EQ(values("Messages/Text").size(), 2U);
    desk.post(messages::MessageKind::OPERATOR_TEXT, "second");
    publish();
    MachineReader next([this] { return Result<client::Viewer>(client::Viewer(memory.segment())); }, {}, &data,
                       nullptr);
    next.set_mark(kept, {});
    next.step(1'700'000'001'000, now_ns);
    const auto texts = values("Messages/Text");
    ASSERT_EQ(texts.size(), 4U) << "a birth, and the message that is new";
    EXPECT_EQ(texts.back(), Value(std::string("second")));
}

TEST_F(MachineReaderTest, BearsAMachineAgainThatHasChanged) {
    publish();
    step();
    const auto before = data.state().generation;
    status->trajectory.axis_mask = 3;
    publish();
    step();
    EXPECT_EQ(data.state().generation, before + 1);
}

}  // namespace
}  // namespace mw::publish
