"""Models written in Python against closed forms; test_fisherhill.py runs them, too."""

import unittest

import numpy as np

import fisherhill as fh

import stub


class Systems(unittest.TestCase):
    """x' = -a x + b u; from x0 with constant u: x = b u/a + (x0 - b u/a) exp(-a t)."""

    times = np.linspace(0, 2, 41)

    def system(self, **given):
        return fh.System(lambda x, u, theta, t: [-theta[0] * x[0] + theta[1] * u[0]], [1.0], self.times,
                         inputs=np.full((41, 1), 0.5), **given)

    def exact(self, theta):
        a, b = theta
        t, rest = self.times, 0.5 * b / a
        x = rest + (1 - rest) * np.exp(-a * t)
        d_a = -0.5 * b / a**2 * (1 - np.exp(-a * t)) - (1 - rest) * t * np.exp(-a * t)
        d_b = 0.5 / a * (1 - np.exp(-a * t))
        return x, np.stack([d_a, d_b], axis=1)

    def with_derivatives(self):
        return self.system(f_x=lambda x, u, theta, t: [[-theta[0]]], f_theta=lambda x, u, theta, t: [[-x[0], u[0]]])

    def test_motion_and_sensitivities_are_the_closed_form(self):
        theta = np.array([1.3, 0.7])
        x, gamma = self.exact(theta)
        for system in (self.system(), self.with_derivatives()):
            np.testing.assert_allclose(system(theta)[:, 0], x, atol=2e-7)
            np.testing.assert_allclose(system.sensitivities(theta), gamma, atol=1e-6)
        fine = self.system(substeps=4)(theta)[:, 0]
        self.assertGreater(np.abs(self.system()(theta)[:, 0] - x).max() / np.abs(fine - x).max(), 100)  # 4^4 = 256

    def test_outputs_and_their_derivatives_may_be_chosen(self):
        theta = np.array([1.3, 0.7])
        given = dict(g=lambda x, u, theta: [x[0] ** 2, theta[1]])
        plain = self.system(**given)
        exact = self.system(f_x=lambda x, u, theta, t: [[-theta[0]]], f_theta=lambda x, u, theta, t: [[-x[0], u[0]]],
                            g_x=lambda x, u, theta: [[2 * x[0]], [0]], g_theta=lambda x, u, theta: [[0, 0], [0, 1]], **given)
        self.assertEqual(plain(theta).shape, (41, 2))
        np.testing.assert_allclose(plain.sensitivities(theta), exact.sensitivities(theta), atol=1e-8)

    def test_information_and_bound_are_the_closed_form(self):
        _, gamma = self.exact([1.3, 0.7])
        information = fh.fisher_information(gamma, 0.1)
        np.testing.assert_allclose(information, gamma.T @ gamma / 0.01, rtol=1e-12)
        np.testing.assert_allclose(fh.cramer_rao_bound(information), np.linalg.inv(information), rtol=1e-9)
        both = fh.fisher_information(np.stack([gamma, 2 * gamma], axis=1), [0.1, 0.2])
        np.testing.assert_allclose(both, 2 * information, rtol=1e-12)
        found = fh.identifiability(information, [1.3, 0.7])
        stub.check(found, "IdentifiabilityResult")
        self.assertEqual(found.rank, 2)
        with self.assertRaisesRegex(ValueError, "spring"):
            fh.cramer_rao_bound([[1.0, 0], [0, 0]], ["mass", "spring"])

    def test_estimate_is_unbiased_and_as_scattered_as_the_bound_says(self):
        theta, noise = np.array([1.3, 0.7]), 0.02
        system = self.with_derivatives()
        random = np.random.default_rng(1)
        clean = system(theta)
        found = [fh.estimate(system, clean + noise * random.standard_normal(clean.shape), noise, [1.0, 1.0]).parameters
                 for _ in range(100)]
        bound = np.sqrt(np.diag(fh.cramer_rao_bound(fh.fisher_information(system.sensitivities(theta), noise))))
        # of 100 draws: the mean within 4 deviations of it, the scatter within 4·7 %
        self.assertTrue(np.all(np.abs(np.mean(found, axis=0) - theta) < 4 * bound / 10))
        np.testing.assert_allclose(np.std(found, axis=0, ddof=1) / bound, 1, atol=0.28)

    def test_a_plain_function_and_gaps_and_priors_do_too(self):
        line = lambda theta: theta[0] + theta[1] * self.times
        measured = line([1, 2])
        measured[5:20] = np.nan
        found = fh.estimate(line, measured, 0.1, [0, 0], names=["offset", "slope"], method="gauss-newton")
        stub.check(found, "EstimateResult")
        np.testing.assert_allclose(found.parameters, [1, 2], atol=1e-8)
        design = np.stack([np.ones(41), self.times], axis=1)[~np.isnan(measured)]
        np.testing.assert_allclose(found.covariance, 0.01 * np.linalg.inv(design.T @ design), rtol=1e-6)
        held = fh.estimate(line, measured, 0.1, [0, 0], names=["offset", "slope"], bounds={"slope": (0, 1.5)},
                           prior={"offset": (1, 1e-6)})
        np.testing.assert_allclose(held.parameters, [1, 1.5], atol=1e-4)
        self.assertEqual(held.at_bound, [False, True])

    def test_mistakes_are_said_and_what_python_raises_comes_back(self):
        for build in (lambda: fh.System(lambda *a: [0], [0.0], [1, 0]),
                      lambda: fh.System(lambda *a: [0], [0.0], [0, 1], inputs=[[0.0]]),
                      lambda: fh.System(lambda *a: [0], [0.0], [0, 1], f_x=lambda *a: [[0]]),
                      lambda: fh.System(lambda *a: [0, 1], [0.0], [0, 1])([1.0]),
                      lambda: fh.fisher_information([1.0], 1),
                      lambda: fh.fisher_information([[1.0]], -1),
                      lambda: fh.estimate(lambda theta: theta, [1.0], 1, [0.0], method="magic"),
                      lambda: fh.estimate(lambda theta: theta, [1.0], 1, [0.0], prior={"mass": (0, 1)})):
            with self.assertRaises(ValueError):
                build()
        with self.assertRaises(ZeroDivisionError):
            fh.System(lambda x, u, theta, t: [1 / 0], [0.0], [0, 1])([1.0])


if __name__ == "__main__":
    unittest.main()
