#include <fmt/format.h>

#include <functional>
#include <sstream>
#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

Eigen::Matrix3d rotationMatrix(const Eigen::Vector3d& xyz) {
  return (Eigen::AngleAxisd(xyz.x(), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(xyz.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(xyz.z(), Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

// "/a/b/../c" → "/a/c"
std::string normalised(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '/');) {
    if (part.empty() || part == ".") continue;
    if (part != "..") {
      parts.push_back(part);
    } else if (!parts.empty()) {
      parts.pop_back();
    }
  }
  std::string joined;
  for (const std::string& part : parts) joined += "/" + part;
  return joined;
}

std::string lastPart(const std::string& path) {
  const auto slash = path.find_last_of('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

// The path may be absolute, relative to the owner or to one of the owner's parents, or a bare name
// of a body.
const BodyFrame* find(const Reading& reading, const std::string& ownerPath,
                      const std::string& path) {
  const auto at = [&](const std::string& absolute) {
    const auto found = reading.frames.find(normalised(absolute));
    return found == reading.frames.end() ? nullptr : &found->second;
  };
  if (path.starts_with('/')) return at(path);
  for (std::string base = ownerPath;; base = base.substr(0, base.find_last_of('/'))) {
    if (const BodyFrame* frame = at(base + "/" + path)) return frame;
    if (base.empty()) break;
  }
  const std::string name = lastPart(path);
  const BodyFrame* body = name == "ground" ? at("/ground") : at("/bodyset/" + name);
  if (body) return body;
  // a frame of that name wherever it stands, if there is only one
  const BodyFrame* found = nullptr;
  for (const auto& [absolute, frame] : reading.frames) {
    if (lastPart(absolute) != name) continue;
    if (found) return nullptr;
    found = &frame;
  }
  return found;
}

// Offset frames may hang on offset frames that come later in the file.
void placeFrames(Reading& reading, std::vector<OffsetFrame> waiting) {
  while (!waiting.empty()) {
    std::vector<OffsetFrame> left;
    for (const OffsetFrame& frame : waiting) {
      const std::string path = frame.ownerPath + "/" + nameOf(reading.source, *frame.element);
      const std::string parent = readText(reading.source, *frame.element, "socket_parent");
      const BodyFrame* base = find(reading, path, parent);
      if (!base) {
        left.push_back(frame);
        continue;
      }
      const auto p = readNumbers(reading.source, *frame.element, "translation", "m", 3,
                                 std::vector<double>{0, 0, 0});
      const auto o = readNumbers(reading.source, *frame.element, "orientation", "rad", 3,
                                 std::vector<double>{0, 0, 0});
      const FramePlacement offset{{p[0], p[1], p[2]}, {o[0], o[1], o[2]}};
      reading.frames[path] = {base->body, compose(base->placement, offset)};
    }
    if (left.size() == waiting.size()) {
      const Element& first = *left.front().element;
      fail(reading.source, first,
           fmt::format("socket_parent = '{}', must name a frame of the model",
                       readText(reading.source, first, "socket_parent")));
    }
    waiting = std::move(left);
  }
}

}  // namespace

FramePlacement compose(const FramePlacement& a, const FramePlacement& b) {
  if (a == FramePlacement{}) return b;
  const Eigen::Matrix3d rotation = rotationMatrix(a.orientation);
  FramePlacement placement;
  placement.translation = a.translation + rotation * b.translation;
  if (b.orientation.isZero(0)) {
    placement.orientation = a.orientation;
  } else if (a.orientation.isZero(0)) {
    placement.orientation = b.orientation;
  } else {
    placement.orientation = (rotation * rotationMatrix(b.orientation)).eulerAngles(0, 1, 2);
  }
  return placement;
}

namespace {

// The offset frames of a list, and those that they hold themselves.
void collect(Reading& reading, const Element* list, const std::string& ownerPath) {
  for (const Element* child : childrenOf(list)) {
    if (std::string_view(child->Name()) != "PhysicalOffsetFrame") continue;
    reading.offsetFrames.push_back({child, ownerPath});
    collect(reading, child->FirstChildElement("components"),
            ownerPath + "/" + nameOf(reading.source, *child));
  }
}

}  // namespace

void readFrames(Reading& reading, const Element& model) {
  reading.frames["/ground"] = {"ground", {}};
  for (const Body& body : reading.model.bodies)
    reading.frames["/bodyset/" + body.name] = {body.name, {}};

  if (const Element* ground = model.FirstChildElement("Ground")) {
    collect(reading, ground->FirstChildElement("components"), "/ground");
  }
  for (const auto& [set, path] :
       {std::pair("BodySet", "/bodyset/"), std::pair("JointSet", "/jointset/")}) {
    for (const Element* object : objectsOf(model, set)) {
      const std::string ownerPath = path + nameOf(reading.source, *object);
      collect(reading, object->FirstChildElement("components"), ownerPath);
      collect(reading, object->FirstChildElement("frames"), ownerPath);
    }
  }
  for (const Element* force : objectsOf(model, "ForceSet")) {
    if (!force->Attribute("name")) continue;
    const std::string ownerPath = std::string("/forceset/") + force->Attribute("name");
    collect(reading, force->FirstChildElement("components"), ownerPath);
    collect(reading, force->FirstChildElement("frames"), ownerPath);
  }
  collect(reading, model.FirstChildElement("components"), "");
  if (const Element* set = model.FirstChildElement("ComponentSet")) {
    collect(reading, set->FirstChildElement("objects"), "/componentset");
  }
  placeFrames(reading, reading.offsetFrames);
}

BodyFrame resolveFrame(const Reading& reading, const Element& owner, const std::string& ownerPath,
                       const char* socket) {
  const std::string path = readText(reading.source, owner, socket);
  if (const BodyFrame* frame = find(reading, ownerPath, path)) return *frame;
  fail(reading.source, owner,
       fmt::format("{} = '{}', must name a frame of the model", socket, path),
       owner.FirstChildElement(socket));
}

}  // namespace bio::osim
