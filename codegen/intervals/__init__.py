"""Which float32 results a specification permits: accuracy tables as data, and intervals under them.

permitted(library, name, inputs, table)  intervals of permitted results, lane by lane
load_table(name), TABLES                 the tables: wgsl, vulkan, glsl, glsl_es, opencl, opencl_relaxed
DEFAULT_TABLES                           target -> the table that judges its default dialect

What is assumed beside the tables:
  order        expressions are evaluated as written; only the sum inside `dot` may take any order
  once         one value is computed once, however often it is used
  fusing       a * b + c may have one rounding where the table says so
  zero         sqrt(0) = 0 and 0 / y = 0, and quotients have their operands' sign: the ULP promises would
               allow more near 0, but no driver is known to use it, and no length would be bounded otherwise
  flushing     below 2^-126 an input or a result may be 0; results there are not told apart otherwise
  anything     overflow, NaN and results outside a promised range are "anything", with the cause; anything
               stays anything through min, max and clamp, since NaN may be among it
  powers of 2  at one, ULP is the larger of the two spacings around it
"""

from codegen.intervals.causes import Cause
from codegen.intervals.permit import Permitted, permitted
from codegen.intervals.tables import DEFAULT_TABLES, TABLES, Table, load_table

__all__ = ["DEFAULT_TABLES", "TABLES", "Cause", "Permitted", "Table", "load_table", "permitted"]
