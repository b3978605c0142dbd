#include <fmt/format.h>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

/// The body frame that carries a marker; "" as body: none of the model.
BodyFrame carrierOf(const Reading& reading, const Element& element) {
  for (const char* socket : {"socket_parent_frame", "socket_parent"}) {
    if (element.FirstChildElement(socket)) return resolveFrame(reading, element, "", socket);
  }
  const std::string body = readText(reading.source, element, "body", "");
  if (body == "ground" || reading.frames.contains("/bodyset/" + body)) return {body, {}};
  return {"", {}};
}

}  // namespace

void readMarkers(Reading& reading, const Element& model) {
  std::map<std::string, int> names;
  for (const Element* element : objectsOf(model, "MarkerSet")) {
    if (std::string_view(element->Name()) != "Marker") continue;
    requireNewName(reading, *element, "marker", names);
    const BodyFrame frame = carrierOf(reading, *element);
    const std::string name = nameOf(reading.source, *element);
    if (frame.body.empty()) {
      reading.model.remarks.push_back(
          fmt::format("{}: is on no body of the model and is left out", label(*element)));
      continue;
    }
    const auto l = readNumbers(reading.source, *element, "location", "m", 3);
    const FramePlacement place = compose(frame.placement, {{l[0], l[1], l[2]}, {0, 0, 0}});
    reading.model.markers.push_back({name, frame.body, place.translation});
  }
}

}  // namespace bio::osim
