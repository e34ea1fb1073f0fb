// SPDX-License-Identifier: GPL-2.0-or-later
// The components of a machine and their data items, as described in a probe of MTConnect.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "clients/publish/readings.hh"

namespace mw::publish::mtconnect {

/// Index of a data item in its model.
using ItemId = std::size_t;
using Filter = std::set<ItemId>;

struct DataItem {
    std::string id{};
    Category category = Category::EVENT;
    std::string type{}, sub_type{}, units{};
    std::optional<std::size_t> metric{};  ///< metric whose value the item has
    const Row *row = nullptr;
    std::size_t component = 0;  ///< index of the component

    /// Name of the element of its observations: "PathFeedrate".
    std::string element() const;
};

struct ModelComponent {
    std::string element, id, name;
    std::size_t parent = 0;  ///< index of the parent; the device is 0 and its own parent
};

class DeviceModel {
  public:
    /// Without metrics, for a machine that was not seen yet.
    DeviceModel(std::string name, std::string uuid, const std::vector<Metric> &metrics);

    const std::string &name() const { return name_; }
    const std::string &uuid() const { return uuid_; }
    const std::vector<ModelComponent> &components() const { return components_; }
    const std::vector<DataItem> &items() const { return items_; }
    ItemId availability() const { return 0; }
    ItemId asset_changed() const { return 1; }
    ItemId asset_removed() const { return 2; }
    /// The data item of a metric.
    std::optional<ItemId> item_of(std::size_t metric) const;
    /// The element Device with its content.
    std::string xml() const;

  private:
    std::size_t component(std::size_t parent, const std::string &element, const std::string &id,
                          const std::string &name);
    std::size_t place_of(const Metric &metric);
    void add(const Metric &metric, std::size_t index);
    std::string component_xml(std::size_t index) const;

    std::string name_, uuid_;
    std::vector<ModelComponent> components_;
    std::vector<DataItem> items_;
};

/// The data items that an XPath selects: those among its nodes and below them. Nothing if the XPath is not
/// valid or needs too many steps.
std::optional<Filter> select(const DeviceModel &model, const std::string &path);

/// `text` with entities for the reserved characters of XML.
std::string escaped(std::string_view text);

}  // namespace mw::publish::mtconnect
