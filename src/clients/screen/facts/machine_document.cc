// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/facts/machine_document.hh"

#include <utility>

#include "clients/screen/http/json_text.hh"
#include "messages/declarations/json_parse.hh"

namespace mw::screen {
namespace {

Json tab_document(const Tab &tab) {
    switch (tab.kind) {
    case Tab::Kind::FRAME:
        return {{"name", tab.name}, {"location", tab.location}, {"kind", "frame"}, {"address", tab.content}};
    case Tab::Kind::PANEL:
        return {{"name", tab.name},
                {"location", tab.location},
                {"kind", "panel"},
                {"panel", messages::parse_json(tab.content)}};
    case Tab::Kind::PROGRAM: break;
    }
    return {{"name", tab.name}, {"location", tab.location}, {"kind", "program"}, {"command", tab.content}};
}

const char *kind_name(MachineKind kind) {
    switch (kind) {
    case MachineKind::MILL: break;
    case MachineKind::LATHE: return "lathe";
    case MachineKind::BACK_LATHE: return "back_lathe";
    case MachineKind::FOAM: return "foam";
    }
    return "mill";
}

}  // namespace

std::string machine_document(const MachineFacts &facts) {
    Json increments = Json::array();
    for (const Increment &increment : facts.increments) {
        increments.push_back(
            {{"text", increment.text}, {"value", increment.value}, {"angular", increment.isAngular}});
    }
    Json spindles = Json::array();
    for (const SpindleFacts &spindle : facts.spindles) {
        spindles.push_back({{"min_override", spindle.min_override},
                            {"max_override", spindle.max_override},
                            {"min_speed", spindle.min_speed},
                            {"max_speed", spindle.max_speed},
                            {"default_speed", spindle.default_speed},
                            {"increment", spindle.increment}});
    }
    Json tabs = Json::array();
    for (const Tab &tab : facts.tabs) {
        tabs.push_back(tab_document(tab));
    }
    return text_of(Json{{"name", facts.name},
                        {"title", facts.title},
                        {"has_icon", !facts.files.icon.empty()},
                        {"keeps_mdi_history", !facts.files.mdi_history.empty()},
                        {"keeps_preferences", !facts.files.preferences.empty()},
                        {"tabs", std::move(tabs)},
                        {"min_linear_velocity", facts.min_linear_velocity},
                        {"min_angular_velocity", facts.min_angular_velocity},
                        {"spindles", std::move(spindles)},
                        {"ini", facts.ini},
                        {"instance", facts.instance},
                        {"axes", facts.axes},
                        {"kind", kind_name(facts.look.kind)},
                        {"geometry", facts.look.geometry},
                        {"foam_z", facts.look.foam_z},
                        {"foam_w", facts.look.foam_w},
                        {"joints", facts.joints},
                        {"joint_kinds", facts.joint_kinds},
                        {"is_homing_forced", facts.isHomingForced},
                        {"linear_unit", facts.linear_unit},
                        {"program_prefix", facts.program_prefix},
                        {"max_linear_velocity", facts.max_linear_velocity},
                        {"default_linear_velocity", facts.default_linear_velocity},
                        {"max_angular_velocity", facts.max_angular_velocity},
                        {"default_angular_velocity", facts.default_angular_velocity},
                        {"max_feed_override", facts.max_feed_override},
                        {"increments", std::move(increments)},
                        {"mdi_commands", facts.mdi_commands},
                        {"program_extensions", facts.program_extensions},
                        {"filter_extensions", facts.filters.extensions},
                        {"filtered_folder", facts.filters.folder}});
}

}  // namespace mw::screen
