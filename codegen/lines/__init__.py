"""Which source line an emitted line says: directives inside the text, a map beside it, and the way back."""
