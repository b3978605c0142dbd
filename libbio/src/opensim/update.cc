#include "opensim/update.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "bio/tables/file_error.h"
#include "opensim/writing.h"
#include "opensim/xml.h"

namespace bio::osim {
namespace {

using tinyxml2::XMLDocument;

std::vector<Element*> partsOf(Element* parent) {
  std::vector<Element*> children;
  if (!parent) return children;
  for (Element* child = parent->FirstChildElement(); child; child = child->NextSiblingElement())
    children.push_back(child);
  return children;
}

std::vector<Element*> objectsIn(Element& owner, const char* set) {
  Element* list = owner.FirstChildElement(set);
  return partsOf(list ? list->FirstChildElement("objects") : nullptr);
}

std::string textOf(const Element& owner, const char* property) {
  return trimmedText(owner.FirstChildElement(property));
}

std::string nameIn(const Element& element) {
  const char* name = element.Attribute("name");
  return name ? name : "";
}

std::string lowerCase(std::string_view text) {
  std::string low(text);
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return low;
}

class Updating {
 public:
  Updating(XMLDocument& document, const std::string& file) : file_(file) {
    Element* root = document.RootElement();
    if (!root || std::string_view(root->Name()) != "OpenSimDocument") return;
    version_ = root->IntAttribute("Version", 0);
    model_ = root->FirstChildElement("Model");
    if (model_ && model_->NextSiblingElement("Model")) {
      fail(*model_->NextSiblingElement("Model"), "is a second Model, a file must hold one");
    }
  }

  std::vector<std::string> run() {
    if (!model_) return {};
    checkTexts(*model_);
    if (version_ >= 30500 && version_ < 40000) updateDialect();
    nameParts();
    for (Joint& joint : joints()) giveCoordinates(*joint.element);
    freeBodies();
    distinguishCoordinates();
    return std::move(remarks_);
  }

 private:
  struct Joint {
    Element* element;
    Element* body;  ///< OpenSim 3: in which it stands
  };

  [[noreturn]] void fail(const Element& element, const std::string& what) const {
    throw FileError(
        fmt::format("{}:{}: {}: {}", file_, element.GetLineNum(), label(element), what));
  }

  // Properties are given once, in one piece.
  void checkTexts(Element& element) {
    std::map<std::string_view, const Element*> seen;
    const std::string_view own = element.Name();
    const bool isList = own == "objects" || own == "components" || own == "defaults";
    for (Element* child : partsOf(&element)) {
      checkTexts(*child);
      if (child->FirstChildElement()) continue;
      checkText(*child);
      if (isList || child->FirstAttribute()) continue;
      const auto [before, isNew] = seen.emplace(child->Name(), child);
      if (isNew || trimmedText(before->second) == trimmedText(child)) continue;
      fail(*child,
           fmt::format("is given twice in {}: '{}' in line {} and '{}' in line {}", label(element),
                       trimmedText(before->second), before->second->GetLineNum(),
                       trimmedText(child), child->GetLineNum()));
    }
  }
  void checkText(Element& element) {
    int texts = 0;
    std::vector<tinyxml2::XMLNode*> comments;
    for (auto* node = element.FirstChild(); node; node = node->NextSibling()) {
      if (node->ToComment()) comments.push_back(node);
      const tinyxml2::XMLText* text = node->ToText();
      if (text && std::string_view(text->Value()).find_first_not_of(" \t\r\n") != std::string::npos)
        ++texts;
    }
    if (comments.empty()) return;
    if (texts > 1) fail(element, "holds a comment inside its text, must be in one piece");
    for (auto* comment : comments) element.DeleteChild(comment);
  }

  void updateDialect() {
    updateSockets(*model_);
    if (Element* set = model_->FirstChildElement("FrameSet")) {
      Element* components = model_->FirstChildElement("components");
      if (!components) components = model_->InsertNewChildElement("components");
      for (Element* frame : objectsIn(*model_, "FrameSet"))
        components->InsertEndChild(frame->DeepClone(frame->GetDocument()));
      model_->DeleteChild(set);
    }
    for (Element* joint : objectsIn(*model_, "JointSet")) {
      reverse(*joint);
      placesToFrames(*joint);
    }
  }

  void updateSockets(Element& element) {
    for (Element* child : partsOf(&element)) updateSockets(*child);
    if (Element* connectors = element.FirstChildElement("connectors")) {
      for (Element* connector : partsOf(connectors)) {
        if (nameIn(*connector).empty()) continue;
        addSocket(element, nameIn(*connector), textOf(*connector, "connectee_name"));
      }
      element.DeleteChild(connectors);
    }
    constexpr std::string_view ending = "_connectee_name";
    for (Element* child : partsOf(&element)) {
      std::string name = child->Name();
      if (name.starts_with("connector_")) name = "socket_" + name.substr(10);
      if (!name.starts_with("socket_")) continue;
      if (name.ends_with(ending)) name.resize(name.size() - ending.size());
      if (name == child->Name()) continue;
      addSocket(element, name.substr(7), trimmedText(child));
      element.DeleteChild(child);
    }
  }
  void addSocket(Element& element, std::string name, const std::string& connectee) {
    if (name == "parent_body") name = "parent_frame";
    if (name == "child_body") name = "child_frame";
    const std::string tag = "socket_" + name;
    if (!element.FirstChildElement(tag.c_str())) appendText(element, tag.c_str(), connectee);
  }

  void reverse(Element& joint) {
    Element* flag = joint.FirstChildElement("reverse");
    if (!flag) return;
    Element* parent = joint.FirstChildElement("socket_parent_frame");
    Element* child = joint.FirstChildElement("socket_child_frame");
    if (lowerCase(trimmedText(flag)) == "true" && parent && child) {
      const std::string before = trimmedText(parent);
      parent->SetText(trimmedText(child).c_str());
      child->SetText(before.c_str());
    }
    joint.DeleteChild(flag);
  }

  void placesToFrames(Element& joint) {
    struct Side {
      const char *socket, *place, *olderPlace, *turn, *olderTurn;
    };
    for (const Side& side :
         {Side{"socket_parent_frame", "location_in_parent", "", "orientation_in_parent", ""},
          Side{"socket_child_frame", "location_in_child", "location", "orientation_in_child",
               "orientation"}}) {
      const auto either = [&](const char* name, const char* older) {
        Element* found = joint.FirstChildElement(name);
        return found || !*older ? found : joint.FirstChildElement(older);
      };
      Element* socket = joint.FirstChildElement(side.socket);
      Element* place = either(side.place, side.olderPlace);
      Element* turn = either(side.turn, side.olderTurn);
      if (!socket || (!place && !turn)) continue;
      std::string base = trimmedText(socket);
      base = base.substr(base.find_last_of('/') + 1);
      Element* frames = joint.FirstChildElement("frames");
      if (!frames) frames = joint.InsertNewChildElement("frames");
      Element* frame = frames->InsertNewChildElement("PhysicalOffsetFrame");
      frame->SetAttribute("name", (base + "_offset").c_str());
      appendText(*frame, "socket_parent", base == "ground" ? "/ground" : "/bodyset/" + base);
      appendText(*frame, "translation", place ? trimmedText(place) : "0 0 0");
      appendText(*frame, "orientation", turn ? trimmedText(turn) : "0 0 0");
      socket->SetText((base + "_offset").c_str());
      if (place) joint.DeleteChild(place);
      if (turn) joint.DeleteChild(turn);
    }
  }

  std::vector<Joint> joints() {
    std::vector<Joint> all;
    for (Element* joint : objectsIn(*model_, "JointSet")) all.push_back({joint, nullptr});
    for (Element* body : objectsIn(*model_, "BodySet"))
      for (Element* joint : partsOf(body->FirstChildElement("Joint"))) all.push_back({joint, body});
    return all;
  }

  void nameParts() {
    for (const char* set : {"BodySet", "ForceSet", "MarkerSet", "ConstraintSet", "ComponentSet"})
      makeUnique(objectsIn(*model_, set));
    std::vector<Element*> all;
    for (const Joint& joint : joints()) all.push_back(joint.element);
    makeUnique(all);
    std::vector<Element*> wraps;
    collectWraps(*model_, wraps);
    makeUnique(wraps);
    nameFrames(*model_);
  }
  void collectWraps(Element& element, std::vector<Element*>& wraps) {
    for (Element* child : partsOf(&element)) {
      if (std::string_view(child->Name()) == "WrapObjectSet") {
        for (Element* wrap : partsOf(child->FirstChildElement("objects"))) wraps.push_back(wrap);
      } else {
        collectWraps(*child, wraps);
      }
    }
  }
  void nameFrames(Element& element) {
    for (Element* child : partsOf(&element)) {
      nameFrames(*child);
      if (std::string_view(child->Name()) == "frames") makeUnique(partsOf(child));
    }
  }

  // As OpenSim has it: an unnamed part is called by its class, a second one of a name by an ending.
  void makeUnique(const std::vector<Element*>& parts) {
    std::set<std::string> used;
    for (Element* part : parts) {
      const std::string given = nameIn(*part);
      const std::string base = given.empty() ? lowerCase(part->Name()) : given;
      std::string name = base;
      for (int count = 0; !used.insert(name).second; ++count)
        name = fmt::format("{}_{}", base, count);
      if (name == given) continue;
      if (given.empty()) {
        remark(*part, fmt::format("has no name and is called '{}'", name));
      } else {
        remark(*part, fmt::format("is a further part of this name and is called '{}'", name));
      }
      part->SetAttribute("name", name.c_str());
    }
  }
  void remark(const Element& element, const std::string& what) {
    remarks_.push_back(fmt::format("line {}: {} {}", element.GetLineNum(), label(element), what));
  }

  static std::size_t numCoordinates(std::string_view kind) {
    static const std::map<std::string_view, std::size_t> counts{
        {"PinJoint", 1},    {"SliderJoint", 1}, {"UniversalJoint", 2}, {"PlanarJoint", 3},
        {"GimbalJoint", 3}, {"BallJoint", 3},   {"EllipsoidJoint", 3}, {"FreeJoint", 6}};
    const auto found = counts.find(kind);
    return found == counts.end() ? 0 : found->second;
  }

  void giveCoordinates(Element& joint) {
    Element* list = joint.FirstChildElement("coordinates");
    std::vector<Element*> given = partsOf(list);
    for (Element* each : objectsIn(joint, "CoordinateSet")) given.push_back(each);
    for (std::size_t k = 0; k < given.size(); ++k) {
      if (!nameIn(*given[k]).empty()) continue;
      const std::string name = fmt::format("{}_coord_{}", nameIn(joint), k);
      remark(*given[k], fmt::format("has no name and is called '{}'", name));
      given[k]->SetAttribute("name", name.c_str());
    }
    const std::size_t needed = numCoordinates(joint.Name());
    if (given.size() >= needed) return;
    if (!list) list = joint.InsertNewChildElement("coordinates");
    for (std::size_t k = given.size(); k < needed; ++k) {
      const std::string name = fmt::format("{}_coord_{}", nameIn(joint), k);
      list->InsertNewChildElement("Coordinate")->SetAttribute("name", name.c_str());
      remark(joint, fmt::format("states no coordinate {}; it is called '{}'", k + 1, name));
    }
  }

  void freeBodies() {
    Element* set = model_->FirstChildElement("JointSet");
    std::set<std::string> moved;
    for (const Joint& joint : joints()) {
      if (joint.body) {
        moved.insert(nameIn(*joint.body));
        continue;
      }
      std::string child = textOf(*joint.element, "socket_child_frame");
      // through offset frames, wherever they stand
      for (int depth = 0; depth < 8; ++depth) {
        const std::string last = child.substr(child.find_last_of('/') + 1);
        const Element* frame = offsetFrame(*joint.element, last);
        if (!frame) frame = offsetFrame(*model_, last);
        if (!frame) break;
        child = textOf(*frame, "socket_parent");
        if (child == "..") {
          const auto* owner = frame->Parent()->Parent()->ToElement();
          if (owner) child = nameIn(*owner);
        }
      }
      moved.insert(child.substr(child.find_last_of('/') + 1));
    }
    for (Element* body : objectsIn(*model_, "BodySet")) {
      const std::string name = nameIn(*body);
      if (name == "ground" || moved.contains(name)) continue;
      remark(*body, fmt::format("is moved by no joint: a FreeJoint 'free_{}' connects it to the "
                                "ground",
                                name));
      Element* joint;
      if (set || version_ >= 30500) {
        if (!set) set = model_->InsertNewChildElement("JointSet");
        Element* objects = set->FirstChildElement("objects");
        if (!objects) objects = set->InsertNewChildElement("objects");
        joint = objects->InsertNewChildElement("FreeJoint");
        appendText(*joint, "socket_parent_frame", "/ground");
        appendText(*joint, "socket_child_frame", "/bodyset/" + name);
      } else {
        Element* holder = body->FirstChildElement("Joint");
        if (!holder) holder = body->InsertNewChildElement("Joint");
        joint = holder->InsertNewChildElement("FreeJoint");
        appendText(*joint, "parent_body", "ground");
      }
      joint->SetAttribute("name", ("free_" + name).c_str());
      Element* list = joint->InsertNewChildElement("coordinates");
      for (int k = 0; k < 6; ++k)
        list->InsertNewChildElement("Coordinate")
            ->SetAttribute("name", fmt::format("free_{}_coord_{}", name, k).c_str());
    }
  }
  static const Element* offsetFrame(const Element& below, const std::string& name) {
    for (const Element* child = below.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      if (std::string_view(child->Name()) == "PhysicalOffsetFrame" && nameIn(*child) == name)
        return child;
      if (const Element* found = offsetFrame(*child, name)) return found;
    }
    return nullptr;
  }

  void distinguishCoordinates() {
    std::map<std::string, int> uses;
    struct Named {
      Element *joint, *coordinate;
    };
    std::vector<Named> all;
    for (const Joint& joint : joints()) {
      std::vector<Element*> own = partsOf(joint.element->FirstChildElement("coordinates"));
      for (Element* each : objectsIn(*joint.element, "CoordinateSet")) own.push_back(each);
      for (Element* each : own) {
        all.push_back({joint.element, each});
        ++uses[nameIn(*each)];
      }
    }
    std::set<std::string> said;
    for (const Named& each : all) {
      const std::string name = nameIn(*each.coordinate);
      if (uses[name] < 2) continue;
      const std::string full = nameIn(*each.joint) + "/" + name;
      if (said.insert(name).second) {
        remarks_.push_back(
            fmt::format("{} coordinates are called '{}'; they are called by joint and name, '{}'",
                        uses[name], name, full));
      }
      each.coordinate->SetAttribute("name", full.c_str());
      Element* transform = each.joint->FirstChildElement("SpatialTransform");
      for (Element* axis : partsOf(transform)) {
        Element* driven = axis->FirstChildElement("coordinates");
        if (driven && trimmedText(driven) == name) driven->SetText(full.c_str());
      }
    }
  }

  const std::string& file_;
  int version_ = 0;
  Element* model_ = nullptr;
  std::vector<std::string> remarks_;
};

}  // namespace

std::vector<std::string> update(XMLDocument& document, const std::string& file) {
  return Updating(document, file).run();
}

}  // namespace bio::osim
