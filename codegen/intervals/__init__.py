"""Which float32 results a specification permits: accuracy tables as data, and intervals under them.

permitted(library, name, inputs, table)  intervals of permitted results, lane by lane
load_table(name), TABLES                 the tables: wgsl, vulkan, glsl, glsl_es, opencl, opencl_relaxed
"""

from codegen.intervals.permitted import Permitted, permitted
from codegen.intervals.tables import DEFAULT_TABLES, TABLES, Table, load_table

__all__ = ["DEFAULT_TABLES", "TABLES", "Permitted", "Table", "load_table", "permitted"]
