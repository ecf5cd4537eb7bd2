"""All arithmetic that determines the bits of a run is fixed by IEEE 754 (docs/design/bits.md)."""

import ast

import pytest
from support.each import each
from support.places import ROOT

CORE = ROOT / 'ins_sim' / 'core'
FILES = {str(path.relative_to(CORE)): path for path in sorted(CORE.rglob('*.py'))}
# The only module with transcendental functions.
ELEMENTARY = 'numerics/elementary.py'
MODULES = {'math', 'cmath', 'np', 'numpy'}
# These differ between C libraries, and in NumPy between processors.
TRANSCENDENTAL = {
    'sin', 'cos', 'tan', 'asin', 'acos', 'atan', 'atan2', 'arcsin', 'arccos', 'arctan', 'arctan2',
    'exp', 'exp2', 'expm1', 'log', 'log1p', 'log2', 'log10', 'logaddexp', 'sinh', 'cosh', 'tanh',
    'asinh', 'acosh', 'atanh', 'arcsinh', 'arccosh', 'arctanh', 'hypot', 'dist', 'pow', 'power',
    'float_power', 'cbrt', 'sinc', 'angle', 'erf', 'erfc', 'gamma', 'lgamma', 'geomspace',
    'logspace', 'phase', 'polar', 'rect', 'i0', 'hanning', 'hamming', 'blackman', 'kaiser'}
# These add in an order that depends on the processor.
PRODUCTS = {'linalg', 'fft', 'dot', 'vdot', 'inner', 'matmul', 'einsum', 'tensordot', 'convolve',
            'correlate', 'polyfit', 'cov', 'corrcoef', 'trapezoid', 'trapz', 'sumprod', 'average',
            'nansum', 'nanmean', 'nanstd', 'nanvar'}
# Along the first axis rows are added one after another; within a row in several parts.
SUMS = {'sum', 'mean', 'std', 'var', 'prod'}
RECORDING = 'a recorded motion is splined by LAPACK: "bits: this machine" in its manifest'
SIGNAL = 'mode signal lives in Fourier transforms: "bits: this machine" in its manifest'
LINEAR_LOOP = 'theory of the closed loop beside flights: printed and plotted, in no array of a run'
# By file: what it uses nevertheless, and why it may.
EXCEPTIONS = {
    'motion/recorded/fitting.py': ({'**', 'mean', 'scipy', 'sum'}, RECORDING),
    'motion/recorded/spline.py': ({'**'}, RECORDING),
    'motion/recorded/faults.py': ({'**', 'cos', 'scipy', 'sin', 'sum'}, RECORDING),
    'motion/recorded/quality.py': ({'**', 'cos', 'mean', 'sin', 'sinc'}, RECORDING),
    'sensors/velocity_meter/pulses.py': ({'**', '@', 'fft', 'linalg', 'mean', 'sum'}, SIGNAL),
    'aiding/mounting_calibration.py': (
        {'**', '@', 'linalg', 'mean', 'sum'},
        'least squares over a whole run; printed with three digits, in no array'),
    'numerics/allan_deviation.py': ({'mean'}, 'printed and plotted, of a finished record'),
    'streams/faults.py': ({'sum'}, 'only whether it is finite counts'),
    'guidance/aided_margin.py': (
        {'**', 'angle', 'exp', 'geomspace', 'linalg', 'log'}, LINEAR_LOOP),
    'guidance/error_loop.py': ({'@', 'arctan2', 'cos', 'exp', 'sin'}, LINEAR_LOOP),
    'guidance/linear_loop.py': (
        {'**', '@', 'angle', 'exp', 'geomspace', 'linalg', 'log', 'scipy'}, LINEAR_LOOP),
}


def bits_of_the_machine(tree):
    """Yield the names and operators in a tree whose results depend on the machine."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            value = node.value
            of_module = isinstance(value, ast.Name) and value.id in MODULES
            if of_module and node.attr in TRANSCENDENTAL | PRODUCTS and not _is_error(node, tree):
                yield node.attr
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
            yield '@'
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
            # For floats this is pow of the C library; for two constants the compiler computes it.
            if not all(isinstance(side, (ast.Constant, ast.UnaryOp))
                       for side in (node.left, node.right)):
                yield '**'
        elif isinstance(node, ast.Call):
            yield from _called(node)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            yield from _imported(node)


def _is_error(node, tree):
    """Return whether a name is used only as numpy.linalg.LinAlgError."""
    return any(isinstance(outer, ast.Attribute) and outer.value is node
               and outer.attr == 'LinAlgError' for outer in ast.walk(tree))


def _called(node):
    function = node.func
    if isinstance(function, ast.Name):
        # From Python 3.12 on sum of floats rounds less than repeated addition.
        if function.id in ('sum', 'pow'):
            yield function.id
    elif isinstance(function, ast.Attribute):
        axes = [ast.unparse(k.value) for k in node.keywords if k.arg == 'axis']
        if function.attr in SUMS and axes != ['0'] or function.attr in ('dot', 'trace'):
            yield function.attr


def _imported(node):
    """Yield the names of machine-dependent functions that an import makes available."""
    base = node.module or '' if isinstance(node, ast.ImportFrom) else ''
    names = {alias.name for alias in node.names}
    for top in {(base or name).partition('.')[0] for name in names} & {'scipy', 'cmath'}:
        yield top
    if base in MODULES:
        yield from names & (TRANSCENDENTAL | PRODUCTS | SUMS)


@each(FILES)
def test_core_leaves_no_bit_to_the_machine(name):
    """core has no transcendental function outside elementary, no BLAS, and no reordered sums."""
    if name != ELEMENTARY:
        found = set(bits_of_the_machine(ast.parse(FILES[name].read_text(encoding='utf-8'))))
        # An exception that is no longer needed must be removed.
        assert found == EXCEPTIONS.get(name, (set(),))[0]


@pytest.mark.parametrize('text, expected', [
    ('math.sin(x)', ['sin']), ('list(map(np.exp, x))', ['exp']), ('x @ y', ['@']),
    ('x ** 3', ['**']), ('2.0 ** -53', []), ('np.linalg.norm(x)', ['linalg']),
    ('raise np.linalg.LinAlgError', []), ('sum(x)', ['sum']), ('x.sum(axis=0)', []),
    ('np.mean(x)', ['mean']), ('x.std(axis=1)', ['std']), ('x.dot(y)', ['dot']),
    ('from math import cos, pi', ['cos']), ('import scipy.linalg', ['scipy']),
    ('from numpy import fft', ['fft']), ('from .elementary import sin\nsin(x)', []),
    ('import cmath', ['cmath']), ('math.sqrt(x) + np.add.reduce(x)', [])])
def test_the_law_sees(text, expected):
    """The check finds calls, functions passed on, operators and imports."""
    assert list(bits_of_the_machine(ast.parse(text))) == expected
