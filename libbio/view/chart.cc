#include "view/chart.h"

#include <fmt/format.h>
#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "view/letters.h"
#include "view/picture.h"

namespace bio::view {
namespace {

constexpr std::array<std::array<unsigned char, 3>, 8> colours = {{{0, 114, 178},
                                                                  {213, 94, 0},
                                                                  {0, 158, 115},
                                                                  {204, 121, 167},
                                                                  {0, 0, 0},
                                                                  {230, 159, 0},
                                                                  {86, 180, 233},
                                                                  {128, 128, 128}}};

vtkSmartPointer<vtkTable> tableOf(const Chart& chart, const ChartCurve& curve) {
  if (curve.x.size() != curve.y.size()) {
    throw std::invalid_argument(fmt::format("curve '{}': {} values of x and {} of y", curve.name,
                                            curve.x.size(), curve.y.size()));
  }
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName(curve.name.c_str());
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const bool shown = std::isfinite(curve.x[i]) && !(chart.xLogarithmic && curve.x[i] <= 0) &&
                       !(chart.yLogarithmic && curve.y[i] <= 0);
    if (!shown) continue;
    x->InsertNextValue(curve.x[i]);
    y->InsertNextValue(curve.y[i]);
  }
  auto table = vtkSmartPointer<vtkTable>::New();
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

void addCurve(vtkChartXY* drawing, const Chart& chart, std::size_t index) {
  const ChartCurve& curve = chart.curves[index];
  const auto table = tableOf(chart, curve);
  if (table->GetNumberOfRows() == 0) return;
  const bool points = curve.style == CurveStyle::points;
  vtkPlot* plot = drawing->AddPlot(points ? vtkChart::POINTS : vtkChart::LINE);
  plot->SetInputData(table, 0, 1);
  plot->SetLabel(curve.name);
  const auto& colour = colours[index % colours.size()];
  plot->SetColor(colour[0], colour[1], colour[2], 255);
  plot->SetWidth(points ? 1.0F : 2.5F);
  constexpr int lines[] = {vtkPen::SOLID_LINE, vtkPen::DASH_LINE, vtkPen::DOT_LINE};
  const std::size_t turn =
      index / colours.size() + (curve.style == CurveStyle::dashed ? std::size_t{1} : 0);
  plot->GetPen()->SetLineType(lines[turn % 3]);
  // Few values, such as one per step size, are marked.
  constexpr vtkIdType few = 40;
  if (auto* marked = vtkPlotPoints::SafeDownCast(plot)) {
    marked->SetMarkerStyle(points || table->GetNumberOfRows() <= few ? vtkPlotPoints::CIRCLE
                                                                     : vtkPlotPoints::NONE);
    marked->SetMarkerSize(points ? 5.0F : 7.0F);
  }
}

/// @param values  what the axis has to show; an axis turns logarithmic only over a positive range
void setAxis(vtkAxis* axis, const std::string& title, bool logarithmic,
             const std::vector<double>& values) {
  axis->SetTitle(title);
  if (logarithmic && !values.empty()) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    axis->SetUnscaledRange(*least, *least < *most ? *most : 10 * *least);
    axis->SetLogScale(true);
  }
  setFont(axis->GetTitleProperties(), false);
  axis->GetTitleProperties()->SetFontSize(18);
  setFont(axis->GetLabelProperties(), false);
  axis->GetLabelProperties()->SetFontSize(16);
  axis->GetGridPen()->SetColor(226, 226, 226, 255);
}

}  // namespace

Image drawChart(const Chart& chart, int width, int height) {
  vtkObject::GlobalWarningDisplayOff();  // a library does not print
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetMultiSamples(0);
  view->GetRenderWindow()->SetSize(width, height);
  vtkNew<vtkChartXY> drawing;
  view->GetScene()->AddItem(drawing);
  drawing->SetTitle(chart.title);
  setFont(drawing->GetTitleProperties(), true);
  drawing->GetTitleProperties()->SetFontSize(22);
  std::vector<double> xs, ys;
  for (const ChartCurve& curve : chart.curves) {
    const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
    std::copy_if(curve.x.begin(), curve.x.end(), std::back_inserter(xs), positive);
    std::copy_if(curve.y.begin(), curve.y.end(), std::back_inserter(ys), positive);
  }
  setAxis(drawing->GetAxis(vtkAxis::BOTTOM), chart.xLabel, chart.xLogarithmic, xs);
  setAxis(drawing->GetAxis(vtkAxis::LEFT), chart.yLabel, chart.yLogarithmic, ys);
  for (std::size_t i = 0; i < chart.curves.size(); ++i) addCurve(drawing, chart, i);
  drawing->SetShowLegend(true);
  drawing->GetLegend()->SetInline(false);
  drawing->GetLegend()->SetHorizontalAlignment(vtkChartLegend::RIGHT);
  drawing->GetLegend()->SetVerticalAlignment(vtkChartLegend::TOP);
  setFont(drawing->GetLegend()->GetLabelProperties(), false);
  drawing->GetLegend()->SetLabelSize(16);
  view->GetRenderWindow()->Render();
  if (chart.xLogarithmic || chart.yLogarithmic) {
    // The first rendering settles the axes; only then do plots take their logarithms.
    for (vtkIdType i = 0; i < drawing->GetNumberOfPlots(); ++i) drawing->GetPlot(i)->Modified();
    drawing->RecalculateBounds();
    view->GetScene()->SetDirty(true);
    view->GetRenderWindow()->Render();
  }
  return imageOf(view->GetRenderWindow(), width, height);
}

}  // namespace bio::view
