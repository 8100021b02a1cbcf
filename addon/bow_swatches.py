# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of the primary bow that each rainbow preset's drops show, from outside to inside: display values, six digits a colour.

Made by `tools/make_bow_swatches.py` from Airy's theory: computing them takes seconds, and a list has to open at once.
"""

from __future__ import annotations

COLORS = {
    "CLASSIC": "281c1d371e1c4f231a6f3015964707c06800e79000ffbc00fee240daf87b88f5b400d1e35e95fab678f1c59cc894b3a0619fa48d84b3a692a6899d96778b9d8f879c8e91927d8994",
    "SUPERNUMERARY": "4b2c205c351e71421c88531ba1681db98025d09b36e3b64df0cf6af4e58aeef3acdbf8ccbbf0e891dafa65b5ff5787f37563d69b6eaab39580b9b47cabbd9d91adba778cbf7371a9",
    "CLOUDBURST": "1717191917192316184314177f1710cb4000ff8600f2c800a6e6006bd87c83b8be91a2dc9298d68e94bf8990ae868da4838a9d8087977f85937e828f7a818c7a7f89797d86777b84",
    "SHOWER": "251d1c2e1e1c3e221b5b28198e3512d05600ff9100ffcb00d4ed2ba0ec828dd6c293bbe69da8eb98a0d9949bc49898b49099aa8592a48d8ea191909a869097808a9883859485878e",
    "FOGBOW": "84745e8d7c6597876ea2937aaea087b9ae97c5bca8cecabad7d6ccdee0dce3e8e9e6eef4e8f1fce7f1ffe4eefedfe8f7d9e0edd0d5dec8cbcebfc1c0babab7babab7babab7babab7",
    "CORONA": "94846e9c8d76a5967faea18ab8ac96c1b7a4cbc3b2d2cfc1d8d8d0dee0dde2e7e8e5ecf2e7eff9e7f1fde6f0ffe4eefde0e9f8dbe3efd5dce4ced4d8caced0caced0caced0caced0",
    "TWINNED": "19181a1e17192e171950181784260dc24c00f58400ffc000c5e7074de4796ebcbb9f9fdf919cdd8e95c38d92af8690a6858b9f838a998085947e86917f818d79818b7d7f88777c86",
    "SEA_SPRAY": "311f1e42221d5a2b1a783a159a5109bf7000e19400f8ba20ffdd4eedf57fbdfab16de7dd23baf97483fcb176e2c09cb4a4b3947aa9a17b8eb49588ac9a96988c9996838e9e88899a",
    "GLASS_BEADS": "221a1c2e1a1b441d1a652715903d08be5f00e88b00ffba00f4e232baf4773be5b511b4e2a083f2c091de93a9b56a9ba39488ab9994a47a939985869a8d8b967d899181849183868d",
}  # fmt: skip
