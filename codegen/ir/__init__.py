"""The typed intermediate representation: types, domains, nodes, verification, text form."""
