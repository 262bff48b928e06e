"""Files that a project keeps a copy of, and what becomes of them.

options.py     what was asked for: functions or a scene, dialects, prefix, layout
plan.py        options to texts: what would be written now
scene_plan.py  the same for the function of a scene
lock.py        vair.lock: the options, what was written and what it promises
state.py       a folder against its lock and against what would be written now
install.py     a plan into a folder, so that old and new files are never mixed
exclusive.py   one run at a time in a folder
exchange.py    two folders change places in one step
changes.py     which functions would change, and what compares them
execution.py   old and new text of a function on one driver
report.py      what was found, as lines and as data
"""
