#include "view/system_scene.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPNGWriter.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <stdexcept>

#include "view/colour_map.h"
#include "view/letters.h"
#include "view/picture.h"
#include "view/solids.h"

namespace bio::view {
namespace {

constexpr Colour background = {0.985, 0.985, 0.98};
constexpr Colour boneColour = {0.89, 0.86, 0.79};
constexpr Colour wrapColour = {0.25, 0.55, 0.85};
constexpr Colour ghostColour = {0.85, 0.35, 0.1};
constexpr Colour groundColour = {0.925, 0.93, 0.935};
constexpr Colour lineColour = {0.8, 0.81, 0.82};
constexpr Colour unknownColour = {0.6, 0.6, 0.6};

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* mesh, const Colour& colour, double opacity = 1) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(colour[0], colour[1], colour[2]);
  property->SetOpacity(opacity);
  property->SetAmbient(0.25);
  property->SetDiffuse(0.75);
  property->SetSpecular(opacity < 1 ? 0 : 0.12);
  property->SetSpecularPower(30);
  return actor;
}

void place(vtkActor* actor, const Placement<double>& X) {
  vtkNew<vtkMatrix4x4> matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix->SetElement(i, j, X.R(i, j));
    matrix->SetElement(i, 3, X.p[i]);
  }
  actor->SetUserMatrix(matrix);
}

bool sameBones(const BodyShape& a, const BodyShape& b) {
  const auto same = [](const TaperedBone& bone, const TaperedBone& other) {
    return bone.from == other.from && bone.to == other.to && bone.shaftRadius == other.shaftRadius;
  };
  return a.geometry == b.geometry &&
         std::equal(a.bones.begin(), a.bones.end(), b.bones.begin(), b.bones.end(), same);
}

bool coincide(const Placement<double>& a, const Placement<double>& b) {
  constexpr double unseen = 1e-4;  // [m], [rad]
  return (a.p - b.p).norm() < unseen && (a.R - b.R).norm() < unseen;
}

/// Light from the camera's side, without shadows: the same brightness wherever one looks from.
void addLight(vtkRenderer* renderer, double elevation, double azimuth, double intensity) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetDirectionAngle(elevation, azimuth);
  light->SetIntensity(intensity);
  renderer->AddLight(light);
}

}  // namespace

Eigen::Vector3d directionOf(Camera camera, const std::vector<Eigen::Vector3d>& points) {
  switch (camera) {
    case Camera::side:
      return {0, 0, 1};
    case Camera::front:
      return {1, 0, 0};
    case Camera::top:
      return {0, 1, 0};
    case Camera::isometric:
      return Eigen::Vector3d(1, 0.8, 1).normalized();
    case Camera::fit:
      break;
  }
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points) mean += Eigen::Vector2d(p.x(), p.z()) / double(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& p : points) {
    const Eigen::Vector2d d = Eigen::Vector2d(p.x(), p.z()) - mean;
    spread += d * d.transpose();
  }
  Eigen::Vector2d thin =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0);
  if (thin.y() < 0) thin = -thin;  // from the right side
  return Eigen::Vector3d(thin.x(), 0.22, thin.y()).normalized();
}

struct SystemScene::Parts {
  struct Body {
    BodyShape shape;
    std::vector<vtkSmartPointer<vtkActor>> actors;  ///< bones and wraps
  };

  SceneOptions options;
  std::vector<std::string> warnings;
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  std::vector<Body> bodies, ghosts;
  vtkNew<vtkLookupTable> colours;
  vtkNew<vtkPolyDataMapper> muscleMapper;
  vtkNew<vtkActor> muscles;
  vtkNew<vtkPolyDataMapper> ghostMapper;
  vtkNew<vtkActor> ghostMuscles;
  vtkNew<vtkTextActor> clock;

  int pixels(double atHeight960) const {
    return std::max(11, static_cast<int>(std::lround(atHeight960 * options.height / 960)));
  }

  void writeAt(vtkTextActor* text, double x, double y, double size, bool bold = false) {
    text->SetTextScaleModeToNone();
    text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    text->SetPosition(x, y);
    vtkTextProperty* letters = text->GetTextProperty();
    setFont(letters, bold);
    letters->SetFontSize(pixels(size));
    // Lines of the ground must not run through the letters.
    letters->SetBackgroundColor(background[0], background[1], background[2]);
    letters->SetBackgroundOpacity(0.75);
    renderer->AddViewProp(text);
  }

  /// From its files, or tapered solids; null if it has no bones.
  vtkSmartPointer<vtkPolyData> bonesOf(const BodyShape& shape, std::vector<std::string>& unusable) {
    vtkSmartPointer<vtkPolyData> bones;
    if (!options.geometry.empty()) bones = meshFromFiles(shape, options.geometry, unusable);
    if (bones || shape.bones.empty()) return bones;
    std::vector<vtkSmartPointer<vtkPolyData>> solids;
    for (const TaperedBone& bone : shape.bones) solids.push_back(meshOf(bone));
    for (const auto& [centre, radius] : shape.joints) solids.push_back(sphereMesh(centre, radius));
    return joined(solids);
  }

  void addBody(const BodyShape& shape, std::vector<std::string>& unusable) {
    Body body{shape, {}};
    if (const auto bones = bonesOf(shape, unusable)) {
      body.actors.push_back(actorOf(bones, boneColour));
    }
    if (options.showWraps) {
      for (const WrapObject& wrap : shape.wraps) {
        const auto mesh = meshOf(wrap);
        if (wrap.active && mesh) body.actors.push_back(actorOf(mesh, wrapColour, 0.3));
      }
    }
    for (const auto& actor : body.actors) renderer->AddActor(actor);
    bodies.push_back(body);
  }

  void addGhost(const BodyShape& shape, std::vector<std::string>& unusable) {
    const auto bones = bonesOf(shape, unusable);
    if (!bones) return;
    Body body{shape, {actorOf(bones, ghostColour, 0.3)}};
    body.actors.front()->GetProperty()->BackfaceCullingOn();  // one layer, not two
    renderer->AddActor(body.actors.front());
    ghosts.push_back(body);
  }

  /// Whether a ghost's bones lie in the very place of the same bones: they would only flicker.
  bool isHidden(const Body& ghost, const Moment& moment) const {
    return std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) {
      return body.shape.name == ghost.shape.name && sameBones(body.shape, ghost.shape) &&
             coincide(moment.posture->bodies.at(body.shape.name),
                      moment.ghost->bodies.at(ghost.shape.name));
    });
  }

  void addGround() {
    const GroundMesh ground = groundMesh(options.middle, options.floor);
    const auto plane = actorOf(ground.plane, groundColour);
    const auto lines = actorOf(ground.lines, lineColour);
    for (const auto& actor : {plane, lines}) {
      actor->GetProperty()->LightingOff();
      renderer->AddActor(actor);
    }
    lines->GetProperty()->SetLineWidth(static_cast<float>(pixels(1.5)) / 8);
  }

  void addMuscles() {
    constexpr int count = 256;
    colours->SetNumberOfTableValues(count);
    colours->SetRange(0, options.largestActivation);
    for (int i = 0; i < count; ++i) {
      const Colour colour = viridis(i / (count - 1.0));
      colours->SetTableValue(i, colour[0], colour[1], colour[2]);
    }
    colours->SetNanColor(unknownColour[0], unknownColour[1], unknownColour[2], 1);
    muscleMapper->SetLookupTable(colours);
    muscleMapper->SetScalarModeToUsePointFieldData();
    muscleMapper->SelectColorArray("activation");
    muscleMapper->UseLookupTableScalarRangeOn();
    muscles->SetMapper(muscleMapper);
    muscles->GetProperty()->SetAmbient(0.35);
    muscles->GetProperty()->SetDiffuse(0.7);
    renderer->AddActor(muscles);
    ghostMapper->ScalarVisibilityOff();
    ghostMuscles->SetMapper(ghostMapper);
    ghostMuscles->GetProperty()->SetColor(ghostColour[0], ghostColour[1], ghostColour[2]);
    ghostMuscles->GetProperty()->SetOpacity(0.45);
    ghostMuscles->GetProperty()->BackfaceCullingOn();
    ghostMuscles->VisibilityOff();
    renderer->AddActor(ghostMuscles);
  }

  void addLegend() {
    vtkNew<vtkScalarBarActor> bar;
    bar->SetLookupTable(colours);
    bar->SetNumberOfLabels(6);
    bar->SetLabelFormat(options.largestActivation < 0.5 ? "%.2f" : "%.1f");
    bar->SetTitle("");
    bar->UnconstrainedFontSizeOn();
    setFont(bar->GetLabelTextProperty(), false);
    bar->GetLabelTextProperty()->SetFontSize(pixels(18));
    bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    bar->SetPosition(0.875, 0.25);
    bar->SetWidth(0.075);
    bar->SetHeight(0.48);
    bar->SetBarRatio(0.4);
    bar->DrawBackgroundOn();
    bar->GetBackgroundProperty()->SetColor(background[0], background[1], background[2]);
    bar->GetBackgroundProperty()->SetOpacity(0.75);
    renderer->AddViewProp(bar);
    vtkNew<vtkTextActor> title;
    title->SetInput("Activation [1]");
    title->GetTextProperty()->SetJustificationToRight();
    writeAt(title, 0.98, 0.755, 20);
  }

  void addCaptions() {
    double y = 0.945;
    bool first = true;
    for (const std::string& line : options.captions) {
      vtkNew<vtkTextActor> text;
      text->SetInput(line.c_str());
      writeAt(text, 0.02, y, first ? 24 : 18, first);
      y -= 0.035;
      first = false;
    }
    vtkNew<vtkTextActor> grid;
    grid->SetInput("Ground: squares of 0.1 m");
    grid->GetTextProperty()->SetJustificationToRight();
    writeAt(grid, 0.98, 0.025, 18);
    if (options.showsTime) writeAt(clock, 0.02, 0.025, 24, true);
  }
};

SystemScene::SystemScene(const std::vector<BodyShape>& bodies, const std::vector<BodyShape>& ghosts,
                         const SceneOptions& options)
    : parts_(std::make_unique<Parts>()) {
  vtkObject::GlobalWarningDisplayOff();  // a library does not print
  Parts& p = *parts_;
  p.options = options;
  p.window->SetOffScreenRendering(1);
  p.window->SetMultiSamples(4);
  p.window->SetSize(options.width, options.height);
  p.window->AddRenderer(p.renderer);
  p.renderer->SetBackground(background[0], background[1], background[2]);
  p.renderer->AutomaticLightCreationOff();
  addLight(p.renderer, 35, -30, 0.75);
  addLight(p.renderer, 5, 40, 0.35);
  p.addGround();
  std::vector<std::string> unusable;
  for (const BodyShape& body : bodies) p.addBody(body, unusable);
  for (const BodyShape& ghost : ghosts) p.addGhost(ghost, unusable);
  std::sort(unusable.begin(), unusable.end());
  unusable.erase(std::unique(unusable.begin(), unusable.end()), unusable.end());
  if (!unusable.empty()) {
    p.warnings.push_back(fmt::format("{}: no readable {}; tapered solids are drawn instead",
                                     options.geometry.string(), fmt::join(unusable, ", ")));
  }
  p.addMuscles();
  if (options.showsActivations) p.addLegend();
  p.addCaptions();
}

SystemScene::~SystemScene() = default;

const std::vector<std::string>& SystemScene::warnings() const {
  return parts_->warnings;
}

void SystemScene::look(const CameraPlace& place) {
  vtkCamera* camera = parts_->renderer->GetActiveCamera();
  const Eigen::Vector3d focus = place.position - place.toCamera;
  camera->SetPosition(place.position.data());
  camera->SetFocalPoint(focus.data());
  camera->SetViewUp(place.up.data());
  camera->SetViewAngle(cameraViewAngle * 180 / std::numbers::pi);
}

Image SystemScene::draw(const Moment& moment) {
  Parts& p = *parts_;
  p.muscleMapper->SetInputData(tubesOf(moment.posture->muscles, moment.activations));
  for (const Parts::Body& body : p.bodies) {
    const Placement<double>& X = moment.posture->bodies.at(body.shape.name);
    for (const auto& actor : body.actors) place(actor, X);
  }
  for (const Parts::Body& ghost : p.ghosts) {
    const bool shown = moment.ghost != nullptr && !p.isHidden(ghost, moment);
    ghost.actors.front()->SetVisibility(shown);
    if (shown) place(ghost.actors.front(), moment.ghost->bodies.at(ghost.shape.name));
  }
  p.ghostMuscles->SetVisibility(moment.ghost != nullptr);
  if (moment.ghost != nullptr) {
    const std::vector<double> unknown(moment.ghost->muscles.size(), 0.0);
    p.ghostMapper->SetInputData(tubesOf(moment.ghost->muscles, unknown));
  }
  p.clock->SetInput(fmt::format("t = {:.3f} s", moment.time).c_str());
  p.renderer->ResetCameraClippingRange();
  p.window->Render();

  return imageOf(p.window, p.options.width, p.options.height);
}

std::string pngOf(const Image& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* to = static_cast<unsigned char*>(data->GetScalarPointer());
  const auto row = 3 * static_cast<std::size_t>(image.width);
  for (std::size_t r = 0; r < static_cast<std::size_t>(image.height); ++r) {
    const std::size_t from = static_cast<std::size_t>(image.height) - 1 - r;
    std::memcpy(to + r * row, image.rgb.data() + from * row, row);
  }
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetCompressionLevel(4);
  writer->SetInputData(data);
  writer->Write();
  const vtkUnsignedCharArray* bytes = writer->GetResult();
  const auto* first = const_cast<vtkUnsignedCharArray*>(bytes)->GetPointer(0);
  return {first, first + bytes->GetNumberOfValues()};
}

}  // namespace bio::view
