"""Tuna, after Thunnus albacares: a spindle with a tail like a sickle moon, keels on its stalk and rows of finlets."""

from viewer.kit.fish_species import Eye, Gill, Keel, MedianFin, Mouth, PairedFin, Part, Section, Species


def _finlet(part: Part, x: float, height: float) -> MedianFin:
    """A small fin that leans back from ``x``."""
    up = 1.0 if part == Part.DORSAL else -1.0
    y = up * (0.018 + 0.3 * (x + 0.36))
    return MedianFin(part, root=((x, 0.8 * up), (x - 0.014, 0.8 * up)),
                     tip=((x - 0.025, y + up * height), (x - 0.0215, y + 0.55 * up * height),
                          (x - 0.0215, y + 0.12 * up * height)),
                     bend=((0.005, 0.002 * up), (0.0, 0.0)), rays=3, thickness=0.004, size=0.25, coarsest=2)


FINLETS = tuple(_finlet(Part.DORSAL, -0.118 - 0.03 * place, 0.020 - 0.0010 * place) for place in range(9)) + tuple(
    _finlet(Part.ANAL, -0.148 - 0.03 * place, 0.020 - 0.0010 * place) for place in range(8))

TUNA = Species(
    name="tuna",
    title="Tuna",
    stalk_end=-0.425,
    sections=(
        #       along   back    belly   width  shoulders fullness
        Section(0.000, -0.010, -0.010, 0.000, 0.00, 0.05),
        Section(0.025, 0.017, -0.036, 0.022, 0.00, 0.05),
        Section(0.100, 0.054, -0.066, 0.047, 0.04, 0.04),
        Section(0.210, 0.092, -0.098, 0.073, 0.06, 0.03),
        Section(0.330, 0.117, -0.119, 0.089, 0.06, 0.02),
        Section(0.450, 0.125, -0.126, 0.092, 0.04, 0.00),
        Section(0.580, 0.112, -0.114, 0.081, 0.02, 0.00),
        Section(0.710, 0.081, -0.083, 0.057, 0.00, 0.00),
        Section(0.820, 0.047, -0.049, 0.032, 0.00, 0.00),
        Section(0.900, 0.0225, -0.0245, 0.0165, 0.00, 0.00),
        Section(0.960, 0.0115, -0.0125, 0.0100, 0.00, 0.00),
        Section(1.000, 0.000, 0.000, 0.000, 0.00, 0.00),
    ),
    eye=Eye(0.402, 0.000, 0.018, 0.22),
    mouth=Mouth((0.5, -0.021), (0.428, -0.042), 0.0028, 0.004, 0.003),
    gill=Gill(0.245, -0.012, 2.4, 0.005, 0.115),
    median_fins=(
        MedianFin(Part.TAIL, root=((-0.392, 0.8), (-0.404, 0.4), (-0.408, 0.0), (-0.404, -0.4), (-0.392, -0.8)),
                  tip=((-0.5, 0.178), (-0.476, 0.13), (-0.459, 0.083), (-0.448, 0.036), (-0.444, 0.0), (-0.448, -0.036),
                       (-0.459, -0.083), (-0.476, -0.13), (-0.5, -0.178)),
                  bend=((0.026, 0.024), (0.012, 0.014), (0.0, 0.0), (0.012, -0.014), (0.026, -0.024)), rays=18,
                  thickness=0.009, flesh=0.5),
        MedianFin(Part.DORSAL, root=((0.225, 0.9), (0.03, 0.9)),
                  tip=((0.15, 0.212), (0.118, 0.187), (0.083, 0.163), (0.047, 0.145), (0.008, 0.13)),
                  bend=((0.02, 0.01), (0.01, 0.004)), rays=13, notch=0.06),
        MedianFin(Part.DORSAL, root=((0.0, 0.9), (-0.075, 0.9)),
                  tip=((-0.118, 0.252), (-0.094, 0.197), (-0.084, 0.153), (-0.092, 0.12), (-0.112, 0.1)),
                  bend=((0.028, 0.0), (0.012, -0.008), (0.0, 0.0)), rays=13, size=0.5),
        MedianFin(Part.ANAL, root=((-0.03, -0.9), (-0.105, -0.9)),
                  tip=((-0.146, -0.25), (-0.122, -0.193), (-0.113, -0.148), (-0.121, -0.113), (-0.14, -0.092)),
                  bend=((0.028, 0.0), (0.012, 0.008), (0.0, 0.0)), rays=13, size=0.5),
        *FINLETS,
    ),
    paired_fins=(
        PairedFin(Part.PECTORAL, root=((0.222, 0.06), (0.208, -0.3)), out=(-0.93, -0.12, 0.34), across=(0.1, 0.95, 0.3),
                  tip=((0.235, -0.03, 0.0), (0.19, -0.032, 0.0), (0.14, -0.03, 0.0), (0.09, -0.03, 0.0),
                       (0.045, -0.03, 0.0)),
                  bend=((0.0, 0.022, 0.012), (0.0, 0.01, 0.012), (0.0, 0.0, 0.006)), rays=16),
        PairedFin(Part.PELVIC, root=((0.196, -0.95), (0.176, -0.95)), out=(-0.85, -0.42, 0.22), across=(0.6, -0.7, 0.3),
                  tip=((0.080, 0.002, 0.0), (0.064, -0.010, 0.0), (0.050, -0.016, 0.0), (0.034, -0.018, 0.0)),
                  bend=((0.0, 0.006, 0.002),), rays=7, coarsest=1),
    ),
    keels=(Keel(-0.374, -0.0005, 0.034, 0.0058, 0.0085),),
)
