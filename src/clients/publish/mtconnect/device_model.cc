// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/mtconnect/device_model.hh"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::publish::mtconnect {
namespace {

constexpr std::array<const char *, 3> CATEGORIES{"SAMPLE", "EVENT", "CONDITION"};

std::string attribute(const char *name, const std::string &value) {
    return value.empty() ? std::string() : fmt::format(" {}=\"{}\"", name, escaped(value));
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (const char c : text) {
        switch (c) {
        case '&': out += "&amp;"; break;
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '"': out += "&quot;"; break;
        default: out += c;
        }
    }
    return out;
}

std::string DataItem::element() const {
    std::string name;
    bool isUpper = true;
    for (const char c : type) {
        if (c == '_') {
            isUpper = true;
        } else {
            name += isUpper ? c : static_cast<char>(c - 'A' + 'a');
            isUpper = false;
        }
    }
    return name;
}

std::size_t DeviceModel::component(std::size_t parent, const std::string &element, const std::string &id,
                                   const std::string &name) {
    const auto found = std::ranges::find(components_, id, &ModelComponent::id);
    if (found != components_.end()) {
        return static_cast<std::size_t>(found - components_.begin());
    }
    components_.push_back({element, id, name, parent});
    return components_.size() - 1;
}

std::size_t DeviceModel::place_of(const Metric &metric) {
    const Component where = metric.row == nullptr ? Component::CONTROLLER : metric.row->item.component;
    switch (where) {
    case Component::AXIS: {
        const std::string letter(1, geometry::AXIS_LETTERS[metric.index]);
        const std::size_t axes = component(0, "Axes", "axes", "");
        return component(axes, geometry::isAngular(metric.index) ? "Rotary" : "Linear",
                         "axis_" + to_lower(letter), letter);
    }
    case Component::SPINDLE: {
        const std::size_t axes = component(0, "Axes", "axes", "");
        return component(axes, "Rotary", fmt::format("spindle_{}", metric.index),
                         fmt::format("S{}", metric.index + 1));
    }
    case Component::CONTROLLER: return component(0, "Controller", "controller", "");
    case Component::PATH:
        return component(component(0, "Controller", "controller", ""), "Path", "path", "path");
    case Component::DEVICE:
    case Component::NONE: break;
    }
    return 0;
}

void DeviceModel::add(const Metric &metric, std::size_t index) {
    const bool isMessage = metric.name == MESSAGE_METRIC;
    if (!isMessage && (metric.row == nullptr || metric.row->item.component == Component::NONE)) {
        return;
    }
    DataItem item;
    item.component = place_of(metric);
    item.metric = index;
    item.row = metric.row;
    item.type = isMessage ? "MESSAGE" : metric.row->item.type;
    if (!isMessage) {
        item.category = metric.row->item.category;
        item.sub_type = metric.row->item.sub_type;
        item.units = metric.row->item.units;
        if (metric.row->item.component == Component::AXIS && geometry::isAngular(metric.index)) {
            item.type = "ANGLE";
            item.units = "DEGREE";
        }
    }
    item.id = to_lower(components_[item.component].id + '_' + item.type +
                       (item.sub_type.empty() ? "" : '_' + item.sub_type));
    items_.push_back(std::move(item));
}

DeviceModel::DeviceModel(std::string name, std::string uuid, const std::vector<Metric> &metrics)
    : name_(std::move(name)), uuid_(std::move(uuid)), components_{{"Device", "device", name_, 0}},
      items_{{.id = "device_availability", .type = "AVAILABILITY"},
             {.id = "device_asset_changed", .type = "ASSET_CHANGED"},
             {.id = "device_asset_removed", .type = "ASSET_REMOVED"}} {
    for (std::size_t i = 0; i < metrics.size(); ++i) {
        add(metrics[i], i);
    }
}

std::optional<ItemId> DeviceModel::item_of(std::size_t metric) const {
    const auto found =
        std::ranges::find_if(items_, [metric](const DataItem &item) { return item.metric == metric; });
    return found == items_.end() ? std::nullopt : std::optional(static_cast<ItemId>(found - items_.begin()));
}

std::string DeviceModel::component_xml(std::size_t index) const {
    const ModelComponent &one = components_[index];
    std::string inner, items;
    for (const DataItem &item : items_) {
        if (item.component == index) {
            items += fmt::format("<DataItem category=\"{}\" id=\"{}\" type=\"{}\"{}{}/>",
                                 CATEGORIES[static_cast<std::size_t>(item.category)], item.id, item.type,
                                 attribute("subType", item.sub_type), attribute("units", item.units));
        }
    }
    for (std::size_t i = 1; i < components_.size(); ++i) {
        inner += components_[i].parent == index ? component_xml(i) : "";
    }
    const std::string uuid = index == 0 ? attribute("uuid", uuid_) : "";
    std::string text =
        fmt::format("<{} id=\"{}\"{}{}>", one.element, one.id, attribute("name", one.name), uuid);
    text += index == 0 ? "<Description manufacturer=\"Millwright\"/>" : "";
    text += items.empty() ? "" : "<DataItems>" + items + "</DataItems>";
    text += inner.empty() ? "" : "<Components>" + inner + "</Components>";
    return text + fmt::format("</{}>", one.element);
}

std::string DeviceModel::xml() const {
    return component_xml(0);
}

}  // namespace mw::publish::mtconnect
