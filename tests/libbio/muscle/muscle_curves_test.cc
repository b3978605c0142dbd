// The curves of the muscle classes: values from an independent prototype, slopes and curvatures
// against differences, dual numbers and each other.
#include <gtest/gtest.h>

#include "support/finite_difference.h"
#include "support/muscle_cases.h"
#include "support/numbers.h"
#include "support/throws_saying.h"

namespace bio::muscles {
namespace {

using support::centralDifference;

struct CurveValueRow {
  double x, value, slope, curvature;
};

template <class Curve>
void expectRows(const Curve& curve, std::initializer_list<CurveValueRow> rows, const char* name) {
  for (const CurveValueRow& row : rows) {
    const CurvePoint<double> f = curve(row.x);
    EXPECT_NEAR(f.value, row.value, 1e-13) << name << " " << row.x;
    EXPECT_NEAR(f.slope, row.slope, 1e-11 * (1 + std::abs(row.slope))) << name << " " << row.x;
    EXPECT_NEAR(f.curvature, row.curvature, 1e-9 * (1 + std::abs(row.curvature)))
        << name << " " << row.x;
  }
}

// The numbers were computed by a prototype in another language (15 digits).
TEST(MillardCurves, HaveTheValuesOfThePrototype) {
  const Millard2012<double> damped{Millard2012Parameters<double>()};
  expectRows([&](double l) { return damped.activeForce(l); },
             {{0.45, 4.86937283390121e-05, 0.0266927542613462, 10.4780279887511},
              {0.5, 0.0985324896187605, 3.43214033885104, 7.76008944222177},
              {0.6, 0.451101878325582, 3.54116927179177, -0.377359474449867},
              {0.73, 0.806305246347259, 1.05186788827252, -8.93858169996069},
              {0.9, 0.956759832542959, 0.850816261976748, -0.6367935533138},
              {1.2, 0.823680970871455, -1.38745876160568, -0.316432385947686},
              {1.5, 0.403344726960772, -1.40374143215542, 0.00543715161653918},
              {1.8, 0.000994314370519905, -0.264360953597381, 47.5798188802635}},
             "f_l");
  expectRows([&](double l) { return damped.passiveForce(l); },
             {{1.02, 0.000877438740108052, 0.120910126635959, 8.67968097643625},
              {1.1, 0.0170448350973784, 0.227348359265968, 0.987033773239617},
              {1.3, 0.126111183482629, 1.07051437119487, 6.22517024693608},
              {1.5, 0.46026150479121, 2.30243984435541, 6.46774684278242},
              {1.7, 1, 2.85714285714286, 0},
              {1.8, 1.28571428571429, 2.85714285714286, 0}},
             "f_PE");
  expectRows([&](double x) { return damped.tendonForce(x - 1); },
             {{1.005, 0.0376044936314221, 11.2516136548913, 470.667941540065},
              {1.01, 0.099678270121973, 13.8360369282058, 693.036536132365},
              {1.02, 0.260935982614927, 19.5840083184092, 812.698843286258},
              {1.03, 0.47939871234805, 23.7416024973738, 554.611299484515},
              {1.049, 1, 28.0612244897959, 0},
              {1.06, 1.30867346938776, 28.0612244897959, 0}},
             "f_T");
  const BezierCurve<double, 4> velocity(forceVelocityCurveOf(Millard2012Parameters<double>()));
  expectRows([&](double v) { return velocity.evaluate(v); },
             {{-0.95, 0.0028515625, 0.125, 1.93132154006243},
              {-0.5, 0.158085604441698, 0.642631454021834, 2.1716822541664},
              {-0.1, 0.625214284312973, 2.29895325847794, 18.4830047474462},
              {0, 1, 5, 0},
              {0.1, 1.22515383775386, 0.684734392201825, -8.69816422102942},
              {0.5, 1.33113156931448, 0.163195514097862, -0.106499154051883},
              {0.95, 1.3991328125, 0.075, -4.36121883656512},
              {-1.3, 0, 0, 0},
              {1.2, 1.4, 0, 0}},
             "f_v");
}

TEST(MillardCurves, OfTheUpperLimbModelHaveTheValuesOfThePrototype) {
  const Millard2012<double> mobl(support::MillardClass::numbers()[2]);
  EXPECT_NEAR(mobl.activeForce(0.6).value, 0.523423057100775, 1e-13);
  EXPECT_NEAR(mobl.activeForce(0.9).value, 0.976846600611089, 1e-13);
  EXPECT_NEAR(mobl.activeForce(1.2).value, 0.747089799373339, 1e-13);
  EXPECT_NEAR(mobl.passiveForce(1.2).value, 0.0263070681850869, 1e-13);
  EXPECT_NEAR(mobl.passiveForce(1.5).value, 0.375381981316362, 1e-13);
  EXPECT_NEAR(mobl.tendonForce(0.005).value, 0.0528653293642785, 1e-13);
  EXPECT_NEAR(mobl.tendonForce(0.015).value, 0.326926, 1e-13);
  EXPECT_NEAR(mobl.tendonForce(0.033).value, 1, 1e-13);
}

// OpenSim's inverse curve, whose slopes at the ends are half those near them, is what an undamped
// muscle with A = 1 moves by.
TEST(MillardCurves, WithoutDampingInvertToThePrototypesInverseCurve) {
  Millard2012Parameters<double> p;
  p.fibreDamping = 0;
  const Millard2012<double> undamped(p);
  const double rows[][2] = {{-0.1, -1.8},
                            {0.01, -0.937994499534893},
                            {0.3, -0.333404908646795},
                            {0.8, -0.0428802275926434},
                            {1.2, 0.0727384571167846},
                            {1.35, 0.643461276194465},
                            {1.5, 2.33333333333333}};
  for (const auto& row : rows) {
    EXPECT_NEAR(undamped.speed(row[0], 1.0, 1.0).v, row[1], 1e-13) << row[0];
  }
}

TEST(ThelenCurves, HaveTheValuesOfThePrototype) {
  const Thelen2003<double> usual{Thelen2003Parameters<double>()};
  EXPECT_NEAR(usual.tendonForce(0.005).value, 0.014727936134132, 1e-14);
  EXPECT_NEAR(usual.tendonForce(0.0243).value, 0.328095582973668, 1e-14);
  EXPECT_NEAR(usual.tendonForce(0.03).value, 0.572032065118414, 1e-14);
  EXPECT_NEAR(usual.tendonForce(0.04).value, 1, 1e-14);
  EXPECT_EQ(usual.tendonForce(-0.01).value, 0);
  EXPECT_NEAR(usual.activeForce(0.5).value, 0.573753420737433, 1e-14);
  EXPECT_NEAR(usual.activeForce(1.3).value, 0.818730753077982, 1e-14);
  EXPECT_NEAR(usual.passiveForce(1.2).value, 0.0291323385009457, 1e-14);
  EXPECT_NEAR(usual.passiveForce(1.5).value, 0.430762717870184, 1e-14);
  const double velocity[][4] = {{-1.2, -0.634782608695652, -0.184, -0.04},
                                {-0.5, -0.147826086956522, 0.0476190476190476, 0.166666666666667},
                                {-0.1, 0.272727272727273, 0.51219512195122, 0.642857142857143},
                                {0, 1, 1, 1},
                                {0.1, 1.37877173913043, 1.32, 1.28571428571429},
                                {0.5, 1.80485869565218, 1.51725, 1.425375},
                                {1.5, 2.87007608695653, 2.00725, 1.731625}};
  const double activations[] = {0.05, 0.5, 1};
  for (const auto& row : velocity) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(usual.forceVelocity(row[0], activations[i]).value, row[i + 1], 1e-13)
          << row[0] << " at " << activations[i];
    }
  }
  const double speed[][2] = {
      {-0.1, -1.40625},           {0, -0.625},   {0.2, -0.104166666666667}, {0.4, 0},
      {0.45, 0.0113636363636364}, {0.52, 0.075}, {0.6, 0.464795918367346}};
  for (const auto& row : speed) {
    EXPECT_NEAR(usual.speed(row[0], 0.5 * 0.8, 0.5).v, row[1], 1e-14) << row[0];
  }
  const Thelen2003<double> gait(support::ThelenClass::numbers()[1]);
  EXPECT_NEAR(gait.tendonForce(0.02).value, 0.32565371007366, 1e-14);
  EXPECT_NEAR(gait.activeForce(0.7).value, 0.835270211411272, 1e-14);
  EXPECT_NEAR(gait.passiveForce(1.2).value, 0.05212246864781, 1e-14);
  EXPECT_NEAR(gait.forceVelocity(0.3, 0.6).value, 1.65822784810127, 1e-14);
  EXPECT_NEAR(gait.forceVelocity(1.0, 0.6).value, 1.78682142857143, 1e-14);
}

TEST(DeGrooteCurves, HaveTheValuesOfThePrototype) {
  const DeGrooteFregly2016<double> usual{DeGrooteFregly2016Parameters<double>()};
  const double rows[][3] = {{0.5, 0.0541121530142743, 0.000565014953778408},
                            {0.8, 0.836439566114652, 0.00473994214398177},
                            {1, 1, 0.0182288238200715},
                            {1.3, 0.581188898378503, 0.13525881677781},
                            {1.6, 0.124255038539749, 1}};
  for (const auto& row : rows) {
    EXPECT_NEAR(usual.activeForce(row[0]).value, row[1], 1e-14) << row[0];
    EXPECT_NEAR(usual.passiveForce(row[0]).value, row[2], 1e-14) << row[0];
  }
  EXPECT_NEAR(usual.tendonForce(-0.01).value, -0.0612529947310519, 1e-14);
  EXPECT_NEAR(usual.tendonForce(0.02).value, 0.215568624600541, 1e-14);
  EXPECT_NEAR(usual.tendonForce(0.049).value, 1, 1e-14);
  const double velocity[][2] = {{-1, 0},
                                {-0.5, 0.234036393548804},
                                {-0.1, 0.745171585030237},
                                {0, 1},
                                {0.1, 1.20650867126025},
                                {0.5, 1.58842340124989},
                                {1, 1.79434296355532}};
  for (const auto& row : velocity) {
    EXPECT_NEAR(usual.forceVelocity(row[0], 1.0).value, row[1], 1e-14) << row[0];
  }
}

// What a curve says of its slope and curvature is what its values and slopes do.
template <class Curve>
void expectSmooth(const Curve& curve, double from, double to, const char* name) {
  double slope = 0, curvature = 0, dual = 0;
  const double scale = std::abs(curve(to).slope) + 1;
  for (int i = 1; i < 400; ++i) {
    const double x = from + (to - from) * (i + 0.137) / 400;
    const CurvePoint<double> f = curve(x);
    const double h = 2e-5 * (to - from);
    slope = std::max(
        slope,
        std::abs(f.slope - centralDifference([&](double t) { return curve(t).value; }, x, h)) /
            scale);
    curvature = std::max(
        curvature,
        std::abs(f.curvature - centralDifference([&](double t) { return curve(t).slope; }, x, h)) /
            (scale + std::abs(f.curvature)));
    using D = info::Dual<1, info::Dual<1>>;
    const auto y = curve(D(info::Dual<1>(x, 1, 0), 1, 0));
    dual = std::max({dual, std::abs(y.value.derivatives()[0].value() - f.slope) / scale,
                     std::abs(y.value.derivatives()[0].derivatives()[0] - f.curvature) /
                         (scale + std::abs(f.curvature)),
                     std::abs(y.slope.derivatives()[0].value() - f.curvature) /
                         (scale + std::abs(f.curvature))});
  }
  EXPECT_LT(slope, 1e-7) << name;
  EXPECT_LT(curvature, 1e-6) << name;
  EXPECT_LT(dual, 1e-9) << name;
  std::printf("%s: slope %.1e, curvature %.1e, dual %.1e\n", name, slope, curvature, dual);
}

template <class Class>
void expectSmoothCurves() {
  for (const auto& p : Class::numbers()) {
    const typename Class::template Shape<double> s(p);
    expectSmooth([&](auto x) { return s.tendonForce(x); }, 0.001, 0.06, "f_T");
    expectSmooth([&](auto x) { return s.activeForce(x); }, 0.46, 1.55, "f_l");
    expectSmooth([&](auto x) { return s.passiveForce(x); }, 1.001, 1.6, "f_PE");
  }
}

TEST(ThelenCurves, HaveTheSlopesAndCurvaturesTheySay) {
  expectSmoothCurves<support::ThelenClass>();
}
TEST(MillardCurves, HaveTheSlopesAndCurvaturesTheySay) {
  expectSmoothCurves<support::MillardClass>();
}
TEST(DeGrooteCurves, HaveTheSlopesAndCurvaturesTheySay) {
  expectSmoothCurves<support::DeGrooteClass>();
}

// speed is the inverse of forceVelocity for any force, with its slopes.
template <class Class>
void expectInverse() {
  double worst = 0, slopes = 0;
  for (const auto& p : Class::numbers()) {
    const typename Class::template Shape<double> s(p);
    for (double a : {0.02, 0.3, 1.0}) {
      for (double f_l : {0.2, 0.7, 1.0}) {
        for (int i = -31; i <= 31; ++i) {
          const double v = 0.0443 * i + 0.00017;
          const double A = a * f_l, P = A * s.forceVelocity(v, a).value + s.damping() * v;
          const FibreSpeed<double> back = s.speed(P, A, a);
          const double size = 1 + std::abs(v) + back.byForce * std::abs(P);
          worst = std::max(worst, std::abs(back.v - v) / size);
          const auto along = [&](double dP, double dA, double da) {
            return s.speed(P + dP, A + dA, a + da).v;
          };
          const double h = 1e-5 * A;
          const double byP = centralDifference([&](double x) { return along(x, 0, 0); }, 0, h);
          const double byA = centralDifference([&](double x) { return along(0, x, 0); }, 0, h);
          const double bya = centralDifference([&](double x) { return along(0, 0, x); }, 0, 1e-5);
          slopes = std::max({slopes, support::relativeError(back.byForce, byP, 1),
                             support::relativeError(back.byActive, byA, 1),
                             support::relativeError(back.byActivation, bya, 1)});
        }
      }
    }
  }
  EXPECT_LT(worst, 1e-13);
  EXPECT_LT(slopes, 1e-6);
  std::printf("%s: speed of force of speed %.1e, slopes %.1e\n",
              Class::template Shape<double>::className, worst, slopes);
}

TEST(MuscleSpeed, IsTheInverseOfThelensForceVelocity) {
  expectInverse<support::ThelenClass>();
}
TEST(MuscleSpeed, IsTheInverseOfMillardsForceVelocity) {
  expectInverse<support::MillardClass>();
}
TEST(MuscleSpeed, IsTheInverseOfDeGrootesForceVelocity) {
  expectInverse<support::DeGrooteClass>();
}

// Whatever the curviness, u is found to rounding: the table is but a start.
TEST(BezierCurve, IsFoundToRoundingForEveryCurviness) {
  double worst = 0;
  for (double curviness : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const BezierCurve<double, 4> curve(
        millardForceVelocity<double>(0.0, 0.25, 5.0, 0.0, 0.15, 1.4, curviness, curviness));
    for (std::size_t i = 0; i < 4; ++i) {
      for (int k = 0; k <= 500; ++k) {
        const double u = k / 500.0;
        const CurvePoint<double> x = quintic(curve.sections()[i].x, u);
        const CurvePoint<double> y = quintic(curve.sections()[i].y, u);
        const CurvePoint<double> f = curve.evaluate(x.value);
        worst = std::max({worst, std::abs(f.value - y.value),
                          std::abs(f.slope - y.slope / x.slope) / (1 + std::abs(f.slope)) * 1e-2});
      }
    }
  }
  EXPECT_LT(worst, 3e-14);
  std::printf("Bezier: %.1e\n", worst);
}

TEST(BezierCurve, HasNoCurvatureWhereSectionsMeet) {
  const BezierCurve<double, 5> curve(activeCurveOf(Millard2012Parameters<double>()));
  for (std::size_t i = 0; i < 5; ++i) {
    for (double side : {-1e-9, 1e-9}) {
      const double x = curve.sections()[i].x[0] + side;
      EXPECT_NEAR(curve.evaluate(x).curvature, 0, 1e-3) << x;
    }
  }
}

TEST(BezierCurve, TakesNotANumberToNotANumber) {
  const BezierCurve<double, 2> curve(tendonCurveOf(Millard2012Parameters<double>()));
  EXPECT_TRUE(std::isnan(curve.evaluate(support::nan).value));
}

TEST(BezierCurve, RefusesASectionThatTurnsBack) {
  support::throwsSaying([] { bezierCorner(0.0, 0.0, 0.0, 1.0, 0.1, 0.01, 0.5); }, "turns back");
}

// Derivatives in a curve's own numbers at places of every section, from a prototype to 8 digits.
TEST(MillardCurves, FollowTheirNumbersAsThePrototypeFound) {
  const Millard2012<double> damped{Millard2012Parameters<double>()};
  using P = Millard2012Parameters<double>;
  const auto own = [](std::string_view name) { return placeOf<P>(name) - common::count; };
  EXPECT_NEAR(
      damped.activeForceInOwn(0.6)[own("ActiveForceLengthCurve/transition_norm_fiber_length")],
      -1.45135787, 1e-8);
  // the stiffnesses follow the strains, where a file does not give them
  EXPECT_NEAR(damped.tendonForceInOwn(0.02)[own("TendonForceLengthCurve/strain_at_one_norm_force")],
              -7.99347278, 1e-8);
  EXPECT_NEAR(damped.passiveForceInOwn(1.3)[own("FiberForceLengthCurve/strain_at_one_norm_force")],
              -0.41460288, 1e-8);
}

}  // namespace
}  // namespace bio::muscles
