#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""smith "spline": the masking of Appendix A, held to the paper's own Eq. (35) to (39) as printed, in 50 digits, under a
natural cubic spline solved apart from the C code; exact at the integers; refused where it is not defined.

Tolerance: the absolute values of the spline's weights sum to at most 1.39; each S_k moves by at most the relative change of
alpha or of the direction's slope, rounded to half a unit each on the way in, and takes about 16 roundings of its own: 1.39
times 18 units, and 5 for their sum: 30 units of 2^-53 or 2^-24, in G1 of [0, 1].
"""
import json
import sys
import tempfile
import unittest

from mpmath import mp, mpf

from command import ROOT, answers, microfacet, musurf, strict

sys.path.insert(0, str(ROOT / "tests/reference"))
from spline import natural_spline, visibility  # noqa: E402

mp.dps = 50
ALPHAS, GAMMAS = (1e-6, 0.01, 0.1, 0.3, 0.6, 0.999), (0.05, 0.5, 0.9, 1, 1.0001, 1.6, 2, 2.3, 3, 3.5, 4)
ANGLES = ((0.01, 1), (0.5, 1), (1, 1), (1, 0.1), (1, 1e-3))  # sine and cosine, up to a factor


def spline(**parameters):
    return microfacet(ndf="gtr", smith="spline", **parameters)


class Spline(unittest.TestCase):
    def worst(self, precision):
        """Largest error of G1; and how many of its values lay outside [S_0, 1] before it was clamped."""
        cases = [(alpha, gamma, angle) for alpha in ALPHAS for gamma in GAMMAS for angle in ANGLES]
        done = musurf("eval", "--precision", precision, stdin=[
            {"material": spline(alpha=alpha, gamma=gamma), "wo": [angle[0], 0, angle[1]], "wm": [0, 0, 1]} for alpha, gamma, angle in cases])
        self.assertEqual(done.returncode, 0, done.out)
        largest, clamped = 0, 0
        for (alpha, gamma, (sine, cosine)), out in zip(cases, answers(done), strict=True):
            s = visibility(mpf(alpha), mpf(cosine) / mpf(sine))
            free = natural_spline(s, mpf(gamma))
            right = min(mpf(1), max(s[0], free))
            clamped += free != right
            largest = max(largest, abs(out["G1"] - right))
        return largest, clamped

    def test_is_what_appendix_a_says(self):
        for precision, bound in (("double", 30 * 2.0**-53), ("float", 30 * 2.0**-24)):
            largest, clamped = self.worst(precision)
            self.assertLess(largest, bound, precision)
            self.assertGreater(clamped, 10)  # the clamp is tested too
            self.assertLess(clamped, 150)

    def test_is_exact_at_integers_only(self):
        for gamma, apart in ((0.5, 1e-4), (1, 0), (1.5, 1e-4), (3, 0), (3.5, 1e-4)):
            lines = [{"material": microfacet(ndf="gtr", smith=smith, alpha=0.3, gamma=gamma), "wo": [1, 0, 0.2], "wm": [0, 0, 1]} for smith in ("exact", "spline")]
            exact, approximate = (answer["G1"] for answer in answers(musurf("eval", stdin=lines)))
            difference = abs(exact - approximate)
            self.assertTrue(difference > apart if apart else difference < 5e-15, (gamma, difference))

    def test_refusals(self):
        for parameters, words in ((dict(ndf="gtr", gamma=4.1), "ends at 4"), (dict(ndf="ggx"), "gtr alone"),
                                  (dict(ndf="gtr", gamma=1, sampler="visible"), "ndf or mixed"),
                                  (dict(ndf="gtr", gamma=1, multiple_scattering="random_walk"), "single scattering alone"),
                                  (dict(ndf="gtr", gamma=1, transmission=True, fresnel={"dielectric": 1.5}), "reflection alone")):
            done = musurf("eval", stdin=[{"material": microfacet(smith="spline", **parameters), "wo": [0, 0, 1]}])
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, done.out)

    def check(self, material):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write(json.dumps({"objects": [{"shape": "sphere", "material": material}]}))
            file.flush()
            return musurf("check", "--json", "--n", 0, file.name)

    def test_check_tells_it_from_exact_masking(self):
        """Eq. (2) is what the paper says the spline closely meets."""
        done = self.check(spline(alpha=0.01, gamma=1.5, sampler="ndf"))
        self.assertEqual(done.returncode, 1, done.err)
        failed = {law["law"] for law in strict(done.out)["laws"] if law["verdict"] == "FAILED"}
        self.assertEqual(failed, {"MASKING", "PROJECTED_AREA", "VISIBLE_NORMALS", "VISIBLE_SAMPLER"})
        self.assertEqual(self.check(spline(alpha=0.01, gamma=3, sampler="ndf")).returncode, 0)

    def test_check_holds_mixtures_to_their_density(self):
        """The sampler agrees with its pdf whatever the masking, however seldom it draws a uniform direction."""
        done = self.check(spline(alpha=0.01, gamma=1.5))
        law = {law["law"]: law["verdict"] for law in strict(done.out)["laws"]}
        self.assertEqual((law["MASKING"], law["SAMPLE_PDF"], law["REJECTION"]), ("FAILED", "ok", "ok"))
        self.assertEqual(self.check(microfacet(ndf="gtr", alpha=0.01, gamma=1.5, sampler="mixed")).returncode, 0)


    def test_the_sampler_is_the_papers_own(self):
        """Unless it says ndf. `pdf` tells them apart."""
        line = {"wo": [0.6, 0, 0.8], "wi": [-0.5, 0.3, 0.6]}
        pdf = {sampler: answers(musurf("eval", stdin=[dict(line, material=spline(alpha=0.3, gamma=1.5, **({"sampler": sampler} if sampler else {})))]))[0]["pdf"]
               for sampler in (None, "auto", "mixed", "ndf")}
        self.assertEqual(pdf[None], pdf["mixed"])
        self.assertEqual(pdf["auto"], pdf["mixed"])
        self.assertNotEqual(pdf["ndf"], pdf["mixed"])


if __name__ == "__main__":
    sys.exit(unittest.main())
